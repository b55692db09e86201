#include "experiments/unit.h"

#include <algorithm>
#include <cmath>
#include <variant>

#include "analysis/tails.h"
#include "estimators/pass_evaluator.h"
#include "experiments/bytes.h"

namespace halfslope {
namespace {

// Replicates whose estimates are held at once: four lane groups.
constexpr std::int64_t kChunk = 4 * kLanes;

std::vector<std::uint64_t> rounds_of(const Pass& pass) {
  std::vector<std::uint64_t> rounds;
  for (const std::uint64_t n : pass.samples) rounds.push_back(n / static_cast<std::uint64_t>(pass.allocation.round()));
  return rounds;
}

}  // namespace

void SpreadSums::add(const Moments& moments) {
  const double second = moments.m2();
  m2 += second;
  m2_squared += second * second;
  m4 += moments.m4();
}

void CellPart::append_to(std::vector<std::byte>& bytes) const {
  for (const std::uint64_t size : {replicates.size(), regions.size(), integrals.size(), worst.size()})
    append_bytes(bytes, size);
  append_bytes<ReplicateSums>(bytes, std::span(replicates));
  append_bytes<std::uint32_t>(bytes, std::span(regions));
  append_bytes<SquaredErrors>(bytes, std::span(squared));
  append_bytes<Moments>(bytes, std::span(integrals));
  append_bytes<double>(bytes, std::span(worst));
  append_bytes(bytes, spread);
  append_bytes(bytes, other_squared_error);
  for (const std::uint64_t number : {nonfinite, first_bad_replicate, first_bad_pixel}) append_bytes(bytes, number);
  abs_error.append_to(bytes);
}

CellPart CellPart::read(std::span<const std::byte> bytes) {
  CellPart part;
  const auto sizes = take_bytes<std::uint64_t>(bytes, 4);
  part.replicates = take_bytes<ReplicateSums>(bytes, sizes[0]);
  part.regions = take_bytes<std::uint32_t>(bytes, sizes[1]);
  part.squared = take_bytes<SquaredErrors>(bytes, sizes[0] * sizes[1]);
  part.integrals = take_bytes<Moments>(bytes, sizes[2]);
  part.worst = take_bytes<double>(bytes, sizes[3]);
  part.spread = take_bytes<SpreadSums>(bytes);
  part.other_squared_error = take_bytes<double>(bytes);
  part.nonfinite = take_bytes<std::uint64_t>(bytes);
  part.first_bad_replicate = take_bytes<std::uint64_t>(bytes);
  part.first_bad_pixel = take_bytes<std::uint64_t>(bytes);
  part.abs_error = LogHistogram::read(bytes);
  return part;
}

std::vector<std::byte> encode_parts(std::span<const CellPart> parts) {
  std::vector<std::byte> body;
  std::vector<std::uint64_t> offsets;
  const std::uint64_t table = (parts.size() + 1) * sizeof(std::uint64_t);
  for (const CellPart& part : parts) {
    offsets.push_back(table + body.size());
    part.append_to(body);
  }
  offsets.push_back(table + body.size());
  std::vector<std::byte> bytes;
  append_bytes<std::uint64_t>(bytes, std::span(offsets));
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

CellPart decode_part(std::size_t index, const ReadSlice& read) {
  const auto table = read(index * sizeof(std::uint64_t), 2 * sizeof(std::uint64_t));
  std::span<const std::byte> cursor(table);
  const auto ends = take_bytes<std::uint64_t>(cursor, 2);
  return CellPart::read(read(ends[0], ends[1] - ends[0]));
}

/// A pass's evaluator and buffers.
struct UnitEvaluator::Worker {
  const Pass* pass;
  std::variant<std::unique_ptr<PassEvaluator<float>>, std::unique_ptr<PassEvaluator<double>>> evaluator;
  std::vector<double> estimates;  ///< [cell][channel][replicate of the chunk]

  Worker(const Plan& plan, const Pass& planned, const SamplerCatalogue& samplers) : pass(&planned) {
    const IntegralSource& source = *plan.scenes[planned.scene].source;
    std::vector<Heuristic> heuristics;
    for (const std::size_t e : planned.estimators)
      heuristics.push_back(plan.scenes[planned.scene].estimators[e].heuristic);
    const auto make = [&]<class T>(T) {
      evaluator =
          std::make_unique<PassEvaluator<T>>(samplers.make(planned.sampler), source.techniques(), planned.allocation,
                                             heuristics, rounds_of(planned), source.channels());
    };
    planned.precision == Precision::kF32 ? make(float{}) : make(double{});
    estimates.resize(heuristics.size() * planned.samples.size() * static_cast<std::size_t>(source.channels() * kChunk));
  }

  void run(const Integral& integral, StreamKey key, std::uint32_t pixel, std::uint32_t replicate) {
    std::visit([&](auto& e) { e->run(integral, key, pixel, replicate); }, evaluator);
  }
  const double* result(std::size_t heuristic, std::size_t n, int channel) const {
    return std::visit([&](const auto& e) { return e->estimates(heuristic, n, channel); }, evaluator);
  }
};

UnitEvaluator::UnitEvaluator(const Plan& plan, std::span<const Reference> references, const SamplerCatalogue& samplers)
    : plan_(plan), references_(references), samplers_(samplers) {}
UnitEvaluator::~UnitEvaluator() = default;

std::vector<CellPart> UnitEvaluator::evaluate(const Unit& unit, const std::function<bool(double)>& progress) {
  const Pass& pass = plan_.passes[unit.pass];
  const PlannedScene& scene = plan_.scenes[pass.scene];
  const Reference& reference = references_[pass.scene];
  const auto channels = static_cast<std::size_t>(scene.source->channels());
  if (!worker_ || worker_->pass != &pass) {
    worker_.reset();
    worker_ = std::make_unique<Worker>(plan_, pass, samplers_);
  }
  Worker& w = *worker_;

  const std::size_t ns = pass.samples.size(), cells = pass.estimators.size() * ns;
  std::vector<CellPart> parts(cells);
  std::vector<std::uint32_t> region_of(unit.pixel_count), regions;
  for (std::size_t t = 0; t < unit.pixel_count; ++t) {
    const auto region = static_cast<std::uint32_t>(scene.source->region(scene.pixels[unit.first_pixel + t]));
    const auto found = std::find(regions.begin(), regions.end(), region);
    region_of[t] = static_cast<std::uint32_t>(found - regions.begin());
    if (found == regions.end()) regions.push_back(region);
  }
  const auto replicates = static_cast<std::size_t>(unit.replicate_count);
  std::vector<bool> wants_integrals(cells, pass.batches() > 1);
  for (const Cell& cell : plan_.cells) {
    if (cell.pass == unit.pass && cell.image) wants_integrals[cell.heuristic * ns + cell.n] = true;
  }
  for (CellPart& part : parts) {
    part.replicates.resize(replicates);
    part.regions = regions;
    part.squared.resize(regions.size() * replicates);
  }

  for (std::size_t t = 0; t < unit.pixel_count; ++t) {
    const std::size_t position = unit.first_pixel + t;
    const int pixel = scene.pixels[position];
    const PixelIntegral integral = scene.source->pixel(pixel);
    std::vector<Moments> moments(cells * channels);
    for (std::size_t first = 0; first < replicates; first += kChunk) {
      const std::size_t chunk = std::min<std::size_t>(kChunk, replicates - first);
      for (std::size_t group = 0; group < chunk; group += kLanes) {
        if (integral.integral) {
          w.run(*integral.integral, pass.key, static_cast<std::uint32_t>(pixel),
                static_cast<std::uint32_t>(static_cast<std::size_t>(unit.first_replicate) + first + group));
        }
        for (std::size_t cell = 0; cell < cells; ++cell) {
          for (std::size_t c = 0; c < channels; ++c) {
            double* out = w.estimates.data() + (cell * channels + c) * kChunk + group;
            const double* in = integral.integral ? w.result(cell / ns, cell % ns, static_cast<int>(c)) : nullptr;
            for (std::size_t l = 0; l < kLanes; ++l) out[l] = integral.constant[c] + (in ? in[l] : 0.0);
          }
        }
      }
      for (std::size_t cell = 0; cell < cells; ++cell) {
        CellPart& part = parts[cell];
        SquaredErrors* squared = part.squared.data() + region_of[t] * replicates + first;
        for (std::size_t c = 0; c < channels; ++c) {
          const std::span<const double> values(w.estimates.data() + (cell * channels + c) * kChunk, chunk);
          const double truth = reference.value[position * channels + c], scale = 1 / (truth * truth + 0.01);
          for (std::size_t r = 0; r < chunk; ++r) {
            const double error = values[r] - truth, magnitude = std::fabs(error);
            ReplicateSums& sums = part.replicates[first + r];
            sums.value += values[r];
            sums.error += error;
            sums.abs_error += magnitude;
            sums.max_abs_error =
                magnitude > sums.max_abs_error || std::isnan(magnitude) ? magnitude : sums.max_abs_error;
            squared[r].plain += error * error;
            squared[r].relative += error * error * scale;
            part.abs_error.add(magnitude);
            if (!std::isfinite(values[r])) {
              const auto replicate = static_cast<std::uint64_t>(unit.first_replicate) + first + r;
              if (part.nonfinite++ == 0 || replicate < part.first_bad_replicate) {
                part.first_bad_replicate = replicate;
                part.first_bad_pixel = static_cast<std::uint64_t>(pixel);
              }
            }
          }
          Moments& so_far = moments[cell * channels + c];
          so_far.add(values);
          const auto n = static_cast<double>(so_far.count);
          for (std::size_t r = 0; r < chunk; ++r) {
            const double deviation = values[r] - so_far.mean;
            part.replicates[first + r].spread += deviation * deviation * (n / (n - 1));
          }
        }
      }
      if (!progress(static_cast<double>(pass.evaluations()) * static_cast<double>(chunk))) return {};
    }
    for (std::size_t cell = 0; cell < cells; ++cell) {
      for (std::size_t c = 0; c < channels; ++c) {
        const Moments& m = moments[cell * channels + c];
        if (wants_integrals[cell]) parts[cell].integrals.push_back(m);
        if (pass.batches() == 1) {
          parts[cell].spread.add(m);
          parts[cell].worst.push_back(mean_squared_error(m, reference.value[position * channels + c]));
        }
      }
    }
  }
  const auto integrals = static_cast<std::int64_t>(scene.pixels.size() * channels);
  for (CellPart& part : parts) part.other_squared_error = keep_largest(part.worst, worst_count(integrals));
  return parts;
}

}  // namespace halfslope
