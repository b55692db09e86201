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

const RegionResult* find_region(const CellResult& cell, const std::string& name) {
  for (const RegionResult& region : cell.regions) {
    if (region.region == name) return &region;
  }
  return nullptr;
}

/// The cells of one scene and precision at one N.
struct Slice {
  std::size_t scene;
  Precision precision;
  std::uint64_t samples;
  std::vector<std::size_t> cells;
};

std::vector<Slice> largest_slices(const Plan& plan) {
  std::vector<Slice> slices;
  for (std::size_t c = 0; c < plan.cells.size(); ++c) {
    const Cell& cell = plan.cells[c];
    auto found = std::find_if(slices.begin(), slices.end(),
                              [&](const Slice& s) { return s.scene == cell.scene && s.precision == cell.precision; });
    if (found == slices.end()) found = slices.insert(found, {cell.scene, cell.precision, 0, {}});
    if (cell.samples > found->samples) found->samples = cell.samples, found->cells.clear();
    if (cell.samples == found->samples) found->cells.push_back(c);
  }
  return slices;
}

// "64 replicates"; "64 to 100 replicates" where a sampler's own are of another number. Those of which there is one
// alone are marked in the table.
std::string replicates_of(const Plan& plan, const Slice& slice) {
  std::int64_t least = 0, most = 1;
  for (const std::size_t c : slice.cells) {
    const Pass& pass = plan.passes[plan.cells[c].pass];
    if (!pass.randomised) continue;
    least = least == 0 ? pass.replicates : std::min(least, pass.replicates);
    most = std::max(most, pass.replicates);
  }
  return (least > 0 && least < most ? fmt::format("{} to ", least) : "") + counted(most, "replicate");
}

std::string main_table(const Plan& plan, const Results& results, const Slice& slice) {
  std::vector<std::vector<std::string>> rows = {
      {"sampler", "estimator", "rmse", "95 %", "relmse", "95 %", "rate", "95 %", "status"}};
  for (const auto& sampler : [&] {
         std::vector<std::string> names;
         for (const std::size_t c : slice.cells) {
           if (std::find(names.begin(), names.end(), plan.cells[c].sampler) == names.end())
             names.push_back(plan.cells[c].sampler);
         }
         return names;
       }()) {
    for (const std::size_t c : slice.cells) {
      const Cell& cell = plan.cells[c];
      if (cell.sampler != sampler) continue;
      const CellStatistics& s = results.cells[c].statistics;
      const auto rate = std::find_if(results.rates.begin(), results.rates.end(), [&](const RateResult& r) {
        const Cell& first = plan.cells[r.first_cell];
        return first.scene == cell.scene && first.estimator == cell.estimator && first.sampler == cell.sampler &&
               first.precision == cell.precision;
      });
      std::string slope = "-", slope_interval;
      if (rate != results.rates.end() && rate->fit.rate) {
        slope = fmt::format("{:.2f}", *rate->fit.rate);
        if (rate->fit.interval)
          slope_interval = fmt::format("[{:.2f}, {:.2f}]", rate->fit.interval->lo, rate->fit.interval->hi);
      } else if (rate != results.rates.end() && rate->fit.samples_hi > 0) {
        slope_interval = rate->fit.status;  // why there is none; the row's own status speaks of this N alone
      }
      rows.push_back({sampler, plan.scenes[cell.scene].estimators[cell.estimator].name, short_number(s.rmse),
                      between(s.rmse_lo, s.rmse_hi), short_number(s.relmse), between(s.relmse_lo, s.relmse_hi), slope,
                      slope_interval, s.status});
    }
  }
  return align(rows, 2);
}

// RMSE of each shape's pixels, a column an estimator, on one sampler.
std::string shape_table(const Plan& plan, const Results& results, const Slice& slice, const std::string& sampler) {
  std::vector<std::vector<std::string>> rows = {{"pixels of"}};
  std::vector<const CellResult*> columns;
  for (const std::size_t c : slice.cells) {
    if (plan.cells[c].sampler != sampler) continue;
    columns.push_back(&results.cells[c]);
    rows[0].push_back(plan.scenes[slice.scene].estimators[plan.cells[c].estimator].name);
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
std::string duel_table(const Plan& plan, const Results& results, const Slice& slice, const std::string& sampler) {
  const CellResult *light = nullptr, *bsdf = nullptr;
  for (const std::size_t c : slice.cells) {
    const std::string& name = plan.scenes[slice.scene].estimators[plan.cells[c].estimator].name;
    if (plan.cells[c].sampler != sampler) continue;
    if (name == "light") light = &results.cells[c];
    if (name == "bsdf") bsdf = &results.cells[c];
  }
  if (!light || !bsdf) return "";
  std::vector<std::string> shapes, lights;
  const auto note = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
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

std::string summary(const Plan& plan, const Results& results) {
  std::string text;
  for (const Slice& slice : largest_slices(plan)) {
    const PlannedScene& scene = plan.scenes[slice.scene];
    text +=
        fmt::format("{}{}, {}, N = {}, {}, {}\n\n", text.empty() ? "" : "\n", scene.name, to_string(slice.precision),
                    slice.samples, counted(scene.pixels.size(), "pixel"), replicates_of(plan, slice));
    text += main_table(plan, results, slice);
    const std::string& sampler = plan.cells[slice.cells.front()].sampler;
    if (results.cells[slice.cells.front()].regions.empty()) continue;
    text += fmt::format("\nRMSE over the pixels that see each shape, with {} points:\n\n", sampler) +
            shape_table(plan, results, slice, sampler);
    if (const std::string duel = duel_table(plan, results, slice, sampler); !duel.empty()) {
      text += fmt::format(
                  "\nrmse(light) / rmse(bsdf) where a shape mirrors a light, with {} points; below 1 the light "
                  "technique wins:\n\n",
                  sampler) +
              duel;
    }
  }
  if (const std::string rates = rates_side_by_side(plan, results); !rates.empty())
    text += "\nrates, the slopes of log RMSE against log N, with 95 % intervals\n\n" + rates;
  return text;
}

}  // namespace halfslope
