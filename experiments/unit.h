// One unit of work: what it measures, and how that is kept.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "analysis/log_histogram.h"
#include "analysis/moments.h"
#include "experiments/plan.h"
#include "experiments/reference.h"

namespace halfslope {

/// Sums over a tile's integrals for one replicate: Σ Î, Σ e, Σ |e|, max |e|; and Σ (Î − m)² n/(n − 1), m the mean of
/// the n replicates of the batch up to the end of those worked on together, this one among them.
struct ReplicateSums {
  double value = 0, error = 0, abs_error = 0, max_abs_error = 0, spread = 0;
};
/// Over those of them that lie in one region: Σ e² and Σ e²/(R̂² + 0.01).
struct SquaredErrors {
  double plain = 0, relative = 0;
};
/// Σ over integrals of their central moments over replicates: m2, m2², m4.
struct SpreadSums {
  double m2 = 0, m2_squared = 0, m4 = 0;
  void add(const Moments& moments);
};

/// What a unit knows of one cell.
struct CellPart {
  std::vector<ReplicateSums> replicates;  ///< of the batch
  std::vector<std::uint32_t> regions;     ///< that the tile touches
  std::vector<SquaredErrors> squared;     ///< [region][replicate]
  std::vector<Moments> integrals;         ///< each integral's; kept where other units or an image need them
  SpreadSums spread;                      ///< of the integrals, where no other unit has replicates of them
  std::vector<double> worst;              ///< likewise: the largest of their mean e², as many as the whole image keeps
  double other_squared_error = 0;         ///< likewise: the sum of the others
  LogHistogram abs_error;
  std::uint64_t nonfinite = 0;
  std::uint64_t first_bad_replicate = 0, first_bad_pixel = 0;  ///< the first replicate with one, its first pixel

  void append_to(std::vector<std::byte>& bytes) const;
  static CellPart read(std::span<const std::byte> bytes);
};

/// A finished unit: the parts of its pass's cells, heuristic-major then N, as a table of offsets and the parts.
std::vector<std::byte> encode_parts(std::span<const CellPart> parts);
/// Where part `index` lies in an encoded unit of `count` parts, read from its table by `read(offset, size)`.
using ReadSlice = std::function<std::vector<std::byte>(std::uint64_t offset, std::uint64_t size)>;
CellPart decode_part(std::size_t index, const ReadSlice& read);

/// Measures units of one plan; one for each thread. Its memory depends on the passes and the tile only.
class UnitEvaluator {
 public:
  UnitEvaluator(const Plan& plan, std::span<const Reference> references, const SamplerCatalogue& samplers);
  ~UnitEvaluator();

  /// All parts of the unit; calls `progress(integrand evaluations)` on the way, and stops early, giving nothing, when
  /// that returns false.
  std::vector<CellPart> evaluate(const Unit& unit, const std::function<bool(double)>& progress);

 private:
  struct Worker;
  const Plan& plan_;
  std::span<const Reference> references_;
  const SamplerCatalogue& samplers_;
  std::unique_ptr<Worker> worker_;  ///< of the pass last worked on: units come in the order of passes
};

}  // namespace halfslope
