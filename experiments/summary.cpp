#include <algorithm>
#include <optional>

#include "core/error.h"
#include "experiments/tables.h"
#include "experiments/text_table.h"

namespace halfslope {
namespace {

std::string short_number(const std::optional<double>& x) { return x ? fmt::format("{:.3g}", *x) : "-"; }
std::string between(const std::optional<double>& lo, const std::optional<double>& hi) {
  return lo || hi ? fmt::format("[{}, {}]", short_number(lo), short_number(hi)) : "";
}

// "1 pixel", "64 replicates".
template <class Count>
std::string counted(Count count, const char* thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

void note(std::vector<std::string>& names, const std::string& name) {
  if (std::ranges::find(names, name) == names.end()) names.push_back(name);
}

const RegionResult* find_region(const CellResult& cell, const std::string& name) {
  for (const RegionResult& region : cell.regions) {
    if (region.region == name) return &region;
  }
  return nullptr;
}

/// The cells of one scene and precision at one N.
struct Slice {
  std::uint64_t samples;
  std::vector<const CellResult*> cells;
};

std::vector<Slice> largest_slices(const Results& results) {
  std::vector<Slice> slices;
  for (const CellResult& cell : results.cells) {
    auto found = std::ranges::find_if(slices, [&](const Slice& s) {
      const CellName& other = s.cells.front()->name;
      return other.scene == cell.name.scene && other.precision == cell.name.precision;
    });
    if (found == slices.end()) found = slices.insert(found, {cell.name.samples, {}});
    if (cell.name.samples > found->samples) found->samples = cell.name.samples, found->cells.clear();
    if (cell.name.samples == found->samples) found->cells.push_back(&cell);
  }
  return slices;
}

// "64 replicates"; "64 to 100 replicates" where cells have others. Those of which there is one alone are marked in the
// table.
std::string replicates_of(const Slice& slice) {
  std::int64_t least = 0, most = 1;
  for (const CellResult* cell : slice.cells) {
    if (cell->facts.deterministic) continue;
    least = least == 0 ? cell->replicates : std::min(least, cell->replicates);
    most = std::max(most, cell->replicates);
  }
  return (least > 0 && least < most ? fmt::format("{} to ", least) : "") + counted(most, "replicate");
}

std::string main_table(const Results& results, const Slice& slice) {
  std::vector<std::vector<std::string>> rows = {
      {"sampler", "estimator", "rmse", "95 %", "relmse", "95 %", "rate", "95 %", "status"}};
  std::vector<std::string> samplers;
  for (const CellResult* cell : slice.cells) note(samplers, cell->name.sampler);
  for (const std::string& sampler : samplers) {
    for (const CellResult* cell : slice.cells) {
      if (cell->name.sampler != sampler) continue;
      const CellStatistics& s = cell->statistics;
      const std::string mark = s.certified ? "" : kNotCertified;
      const auto marked = [&](const std::string& interval) { return interval.empty() ? "" : mark + interval; };
      const auto rate = std::ranges::find_if(
          results.rates, [&](const RateResult& r) { return same_line(results.cells[r.first_cell].name, cell->name); });
      std::string slope = "-", slope_interval;
      if (rate != results.rates.end() && rate->fit.rate) {
        slope = fmt::format("{:.2f}", *rate->fit.rate);
        slope_interval = rate_interval_text(rate->fit);
      } else if (rate != results.rates.end() && rate->fit.samples_hi > 0) {
        slope_interval = rate->fit.status;  // why there is none; the row's own status speaks of this N alone
      }
      rows.push_back({sampler, cell->name.estimator, short_number(s.rmse), marked(between(s.rmse_lo, s.rmse_hi)),
                      short_number(s.relmse), marked(between(s.relmse_lo, s.relmse_hi)), slope, slope_interval,
                      s.status});
    }
  }
  const std::string text = align(rows, 2);
  return text + explained_marks(text);
}

std::string differences(const Results& results, const CellResult& cell) {
  for (const ComparisonFamily& family : results.comparisons) {
    const CellName& name = results.cells[family.cells.front()].name;
    if (name.scene == cell.name.scene && name.precision == cell.name.precision && name.samples == cell.name.samples)
      return comparisons_text(results, family);
  }
  return "";
}

// RMSE of each shape's pixels, a column an estimator, on one sampler.
std::string shape_table(const Slice& slice, const std::string& sampler) {
  std::vector<std::vector<std::string>> rows = {{"pixels of"}};
  std::vector<const CellResult*> columns;
  for (const CellResult* cell : slice.cells) {
    if (cell->name.sampler != sampler) continue;
    columns.push_back(cell);
    rows[0].push_back(cell->name.estimator);
  }
  for (const RegionResult& region : columns.front()->regions) {
    if (region.region == "all" || region.region.find('/') != std::string::npos) continue;
    std::vector<std::string> row = {region.region};
    bool measured = false;
    for (const CellResult* column : columns) {
      const RegionResult* found = find_region(*column, region.region);
      measured |= found && found->rmse;
      row.push_back(found ? short_number(found->rmse) : "-");
    }
    if (measured) rows.push_back(row);
  }
  return align(rows, 1);
}

// rmse(light) / rmse(bsdf) for each shape and the light it mirrors: below 1 the light technique wins.
std::string duel_table(const Slice& slice, const std::string& sampler) {
  const CellResult *light = nullptr, *bsdf = nullptr;
  for (const CellResult* cell : slice.cells) {
    if (cell->name.sampler != sampler) continue;
    if (cell->name.estimator == "light") light = cell;
    if (cell->name.estimator == "bsdf") bsdf = cell;
  }
  if (!light || !bsdf) return "";
  std::vector<std::string> shapes, lights;
  for (const RegionResult& region : light->regions) {
    const auto slash = region.region.find('/');
    if (slash == std::string::npos || !region.rmse) continue;
    note(shapes, region.region.substr(0, slash));
    note(lights, region.region.substr(slash + 1));
  }
  if (lights.size() < 2) return "";
  std::sort(lights.begin(), lights.end());
  std::vector<std::vector<std::string>> rows = {{"light/bsdf"}};
  rows[0].insert(rows[0].end(), lights.begin(), lights.end());
  for (const auto& shape : shapes) {
    std::vector<std::string> row = {shape};
    for (const auto& name : lights) {
      const RegionResult* a = find_region(*light, shape + "/" + name);
      const RegionResult* b = find_region(*bsdf, shape + "/" + name);
      row.push_back(a && b && a->rmse && b->rmse ? short_number(*a->rmse / *b->rmse) : "-");
    }
    rows.push_back(row);
  }
  return align(rows, 1);
}

}  // namespace

std::string summary(const Results& results) {
  std::string text;
  for (const Slice& slice : largest_slices(results)) {
    const CellResult& first = *slice.cells.front();
    text += fmt::format("{}{}, {}, N = {}, {}, {}\n\n", text.empty() ? "" : "\n", first.name.scene,
                        first.name.precision, slice.samples, counted(first.pixels, "pixel"), replicates_of(slice));
    text += main_table(results, slice);
    if (const std::string told = differences(results, *slice.cells.front()); !told.empty()) text += "\n" + told;
    const std::string& sampler = first.name.sampler;
    if (first.regions.empty()) continue;
    text += fmt::format("\nRMSE over the pixels that see each shape, with {} points:\n\n", sampler) +
            shape_table(slice, sampler);
    if (const std::string duel = duel_table(slice, sampler); !duel.empty()) {
      text += fmt::format(
                  "\nrmse(light) / rmse(bsdf) where a shape mirrors a light, with {} points; below 1 the light "
                  "technique wins:\n\n",
                  sampler) +
              duel;
    }
  }
  if (const std::string rates = rates_side_by_side(results); !rates.empty())
    text += "\nrates, the slopes of log RMSE against log N, with 95 % intervals\n\n" + rates;
  if (const std::string remarks = rate_remarks(results); !remarks.empty()) text += "\n" + remarks;
  return text;
}

}  // namespace halfslope
