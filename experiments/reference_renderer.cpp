#include "experiments/reference_renderer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>

#include "analysis/compensated_sum.h"
#include "core/assertion.h"
#include "core/atomic_file.h"
#include "core/error.h"
#include "core/hash64.h"
#include "core/kernel_library.h"
#include "core/version.h"
#include "estimators/pass_evaluator.h"
#include "experiments/bytes.h"
#include "experiments/interrupt.h"
#include "experiments/message.h"
#include "experiments/parallel.h"
#include "experiments/progress.h"

namespace halfslope {
namespace {

constexpr std::size_t kTile = 16;
constexpr std::size_t kFewPixels = 256;

/// What one task adds: a tile of pixels over a chunk of replicates.
struct Piece {
  std::vector<Moments> moments;  ///< of the tile's integrals
  std::vector<double> half;      ///< their means over the first half of the chunk
  std::vector<double> sums;      ///< Σ over them, for each replicate of the chunk
};

}  // namespace

ReferenceRenderer::ReferenceRenderer(const IntegralSource& source, const std::string& name,
                                     const std::vector<int>& pixels, const ReferenceGoal& goal,
                                     const ReferenceOptions& options, const SamplerCatalogue& samplers)
    : source_(source), name_(name), pixels_(pixels), options_(options), samplers_(samplers) {
  allocation_.techniques = source.reference_techniques();
  allocation_.counts.assign(allocation_.techniques.size(), 1);
  if (const PathShape* path = source.path()) allocation_.path = *path;
  const auto round = static_cast<std::uint64_t>(allocation_.round());
  rounds_ = std::max<std::uint64_t>(2, goal.samples / round);
  if (const auto legal = samplers.make("halton-owen")->illegal(rounds_, allocation_.layout(source.techniques()))) {
    fail(ExitCode::kBadInput, "scene '{}': a reference takes at most N = {} samples a replicate, asked for {}", name,
         legal->below.value_or(0) * round, rounds_ * round);
  }
  // Everything that the replicates depend on, and the shape of what is kept of them.
  key_text_ = fmt::format("halfslope {} reference in halves, from replicate {}\n{}\n{}\nrounds {}\npixels", version(),
                          kFirstReferenceReplicate, isa_class(active_isa()), source.fingerprint(), rounds_);
  for (const int pixel : pixels) key_text_ += fmt::format(" {}", pixel);
}

void ReferenceRenderer::render(ReferenceState& state, std::int64_t replicates) {
  const auto channels = static_cast<std::size_t>(source_.channels());
  const std::int64_t first = state.replicates(), more = replicates - first;
  // Few pixels are split over replicates too, so that every core has work; pieces are joined in their order.
  const std::size_t chunk = pixels_.size() <= kFewPixels ? kLanes : static_cast<std::size_t>(more);
  const std::size_t chunks = static_cast<std::size_t>(more) / chunk;
  const std::size_t tile_pixels = pixels_.size() <= kFewPixels ? 1 : kTile;
  const std::size_t tiles = (pixels_.size() + tile_pixels - 1) / tile_pixels;
  assert_equal(more, std::max<std::int64_t>(first, kLanes), "replicates that a reference is extended by");
  const StreamKey key = stream_key(0, "halton-owen", "reference");
  Progress progress(fmt::format("{}: reference, replicates {} to {}", name_, first + 1, replicates),
                    static_cast<double>(samples()) * static_cast<double>(more) * static_cast<double>(pixels_.size()),
                    options_.quiet);
  std::atomic<bool> stop = false;
  std::vector<Piece> pieces(tiles * chunks);
  const auto work = [&](std::size_t index) {
    const std::size_t tile = index / chunks, begin = index % chunks * chunk;
    PassEvaluator<double> evaluator(
        samplers_.make("halton-owen"), source_.techniques(), allocation_,
        {{allocation_.techniques.size() == 1 ? HeuristicKind::kSingle : HeuristicKind::kBalance, 0}}, {rounds_},
        source_.channels());
    Piece& piece = pieces[index];
    piece.sums.resize(chunk);
    std::vector<double> values(channels * chunk);
    const auto row = [&](std::size_t c) { return values.data() + c * chunk; };
    const std::size_t end = std::min(pixels_.size(), (tile + 1) * tile_pixels);
    for (std::size_t p = tile * tile_pixels; p < end; ++p) {
      const PixelIntegral pixel = source_.pixel(pixels_[p]);
      for (std::size_t r = 0; r < chunk; r += kLanes) {
        if (interrupted()) stop = true;
        if (stop) return;
        if (pixel.integral) {
          evaluator.run(
              *pixel.integral, key, static_cast<std::uint32_t>(pixels_[p]),
              kFirstReferenceReplicate + static_cast<std::uint32_t>(static_cast<std::size_t>(first) + begin + r));
        }
        for (std::size_t c = 0; c < channels; ++c) {
          const double* in = pixel.integral ? evaluator.estimates(0, 0, static_cast<int>(c)) : nullptr;
          for (std::size_t l = 0; l < kLanes; ++l) row(c)[r + l] = pixel.constant[c] + (in ? in[l] : 0.0);
        }
        progress.advance(static_cast<double>(samples()) * kLanes);
      }
      for (std::size_t c = 0; c < channels; ++c) {
        Moments half;
        half.add(std::span<const double>(row(c), chunk / 2));
        piece.half.push_back(half.mean);
        piece.moments.emplace_back().add(std::span<const double>(row(c), chunk));
        for (std::size_t r = 0; r < chunk; ++r) piece.sums[r] += row(c)[r];
      }
    }
  };
  with_threads(options_.threads,
               [&](int) { tbb::parallel_for(std::size_t{0}, pieces.size(), work, tbb::simple_partitioner()); });
  if (stop) fail(ExitCode::kInterrupted, "interrupted while the reference was rendered; run again to start it anew");
  progress.finish();

  // What there was is one half; of the very first replicates, which are one chunk, their own first half is.
  const bool at_first = state.moments.empty();
  state.moments.resize(pixels_.size() * channels);
  state.half.resize(state.moments.size());
  for (std::size_t i = 0; i < state.half.size(); ++i) state.half[i] = state.moments[i].mean;
  for (std::size_t index = 0; index < pieces.size(); ++index) {
    const std::size_t offset = index / chunks * tile_pixels * channels;
    for (std::size_t i = 0; i < pieces[index].moments.size(); ++i) {
      state.moments[offset + i].merge(pieces[index].moments[i]);
      if (at_first) state.half[offset + i] = pieces[index].half[i];
    }
  }
  for (std::size_t r = 0; r < static_cast<std::size_t>(more); ++r) {
    CompensatedSum sum;
    for (std::size_t t = 0; t < tiles; ++t) sum.add(pieces[t * chunks + r / chunk].sums[r % chunk]);
    state.replicate_sums.push_back(sum.value());
  }
}

std::filesystem::path ReferenceRenderer::file(std::int64_t replicates) const {
  const std::string key = full_key(replicates);
  return options_.cache / fmt::format("reference-{:016x}", hash64(std::as_bytes(std::span(key))));
}

bool ReferenceRenderer::load(ReferenceState& state, std::int64_t replicates) const {
  if (options_.cache.empty()) return false;
  try {
    const std::string text = read_file(file(replicates));
    std::span<const std::byte> cursor = std::as_bytes(std::span(text));
    const auto checksum = take_bytes<std::uint64_t>(cursor);
    if (checksum != hash64(cursor)) return false;
    const std::string key = full_key(replicates);
    const auto found = take_bytes<char>(cursor, std::min(cursor.size(), key.size()));
    if (!std::equal(found.begin(), found.end(), key.begin(), key.end())) return false;
    const std::size_t integrals = pixels_.size() * static_cast<std::size_t>(source_.channels());
    ReferenceState found_state;
    found_state.moments = take_bytes<Moments>(cursor, integrals);
    found_state.half = take_bytes<double>(cursor, integrals);
    found_state.replicate_sums = take_bytes<double>(cursor, static_cast<std::size_t>(replicates));
    state = std::move(found_state);
    return true;
  } catch (const Error&) {
    return false;  // a damaged or unreadable cache is no cache: render again
  }
}

void ReferenceRenderer::save(const ReferenceState& state) const {
  if (options_.cache.empty()) return;
  std::vector<std::byte> body;
  const std::string key = full_key(state.replicates());
  append_bytes<char>(body, std::span(key));
  append_bytes<Moments>(body, std::span(state.moments));
  append_bytes<double>(body, std::span(state.half));
  append_bytes<double>(body, std::span(state.replicate_sums));
  std::vector<std::byte> bytes;
  append_bytes(bytes, hash64(body));
  bytes.insert(bytes.end(), body.begin(), body.end());
  try {
    std::filesystem::create_directories(options_.cache);
    write_file_atomically(file(state.replicates()), {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  } catch (const std::exception& error) {
    if (!options_.quiet) message("halfslope: the reference is not kept for later: {}\n", error.what());
  }
}

}  // namespace halfslope
