// Nested scrambling against what one would write without kernels, on one core. The counter `ratio` of each benchmark is
// how many times as much processor time the other takes for as many coordinates, both taken in turns within it. Floors:
//   sobol-owen-fast, 2-D: Boost's engine, which scrambles nothing; 4 with AVX-512, 2 with AVX2;
//   sobol-owen: a scalar loop with a hash for each of the digits; 20;
//   halton-owen: a scalar loop with a permutation for each digit, until 32 bits are full; 8.
#include <benchmark/benchmark.h>

#include <boost/random/sobol.hpp>
#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <string>
#include <vector>

#include "core/kernel_library.h"
#include "samplers/catalogue.h"
#include "samplers/radical_inverse.h"
#include "samplers/sobol_sequence.h"

namespace halfslope {
namespace {

constexpr int kBlock = 32;

/// Wellons's 32-bit finaliser over a seed.
std::uint32_t hash(std::uint32_t x, std::uint32_t seed) {
  x ^= seed;
  x = (x ^ (x >> 16)) * 0x21f0aaadu;
  x = (x ^ (x >> 15)) * 0x735a2d97u;
  return x ^ (x >> 15);
}

/// The first `count` coordinates of every dimension of kLanes replicates, by the definition.
using Plain = void (*)(int dims, std::uint32_t count, std::uint32_t seed, std::vector<std::uint32_t>& out);

void boost_sobol(int dims, std::uint32_t count, std::uint32_t, std::vector<std::uint32_t>& out) {
  boost::random::sobol engine(static_cast<std::size_t>(dims));
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count * kLanes; ++i) {
    for (int d = 0; d < dims; ++d) out[at++] = static_cast<std::uint32_t>(engine() >> 32);
    if (at + static_cast<std::size_t>(dims) > out.size()) at = 0;
  }
}

void hash_for_each_digit(int dims, std::uint32_t count, std::uint32_t seed, std::vector<std::uint32_t>& out) {
  SobolSequence sequence;
  sequence.reserve(dims);
  std::size_t at = 0;
  for (int d = 0; d < dims; ++d) {
    for (std::uint32_t i = 0; i < count; ++i) {
      const std::uint32_t y = sequence.at(d, i);
      for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
        const std::uint32_t key = hash(lane + kLanes * static_cast<std::uint32_t>(d), seed);
        std::uint32_t x = y ^ (hash(1, key) & 0x80000000u);
        for (std::uint32_t k = 1; k < 32; ++k) {
          const std::uint32_t node = (1u << k) | (y >> (32 - k));
          x ^= (hash(node, key) & 1u) << (31 - k);
        }
        out[at++] = x;
        if (at == out.size()) at = 0;
      }
    }
  }
}

void permutation_for_each_digit(std::uint32_t base, std::uint32_t count, std::uint32_t seed,
                                std::vector<std::uint32_t>& out) {
  std::size_t at = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
      const std::uint32_t key = hash(lane, seed);
      std::uint32_t rest = i, prefix = 0;
      double x = 0, unit = 0x1p32;
      for (std::uint32_t k = 0; unit > 1; ++k) {
        const std::uint32_t node = hash(prefix + k * 0x9e3779b9u, key), digit = rest % base;
        const std::uint32_t g = static_cast<std::uint32_t>((std::uint64_t{node} * base) >> 32);
        const std::uint32_t h = 1 + static_cast<std::uint32_t>((std::uint64_t{hash(node, key)} * (base - 1)) >> 32);
        unit /= base;
        x += (g + h * digit) % base * unit;
        prefix = prefix * base + digit;
        rest /= base;
      }
      out[at++] = static_cast<std::uint32_t>(x);
      if (at == out.size()) at = 0;
    }
  }
}

void digit_by_digit(int dims, std::uint32_t count, std::uint32_t seed, std::vector<std::uint32_t>& out) {
  for (int d = 0; d < dims; ++d) {
    permutation_for_each_digit(primes()[static_cast<std::size_t>(d)], count, seed + static_cast<std::uint32_t>(d), out);
  }
}

/// Processor time, which other processes on the machine leave alone.
double seconds_now() {
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec) * 1e-9;
}

/// `count` points of `name` in `dims` dimensions, prepared anew for each pixel as an experiment does.
void against(benchmark::State& state, const std::string& isa, const std::string& name, int dims, std::uint32_t count,
             Plain plain) {
  setenv("HALFSLOPE_ISA", isa.c_str(), 1);
  const auto sampler = SamplerCatalogue::built_in().make(name);
  const Layout layout = {std::vector<std::uint8_t>(static_cast<std::size_t>(dims), 1)};
  PointBlock block;
  std::vector<std::uint32_t> out(static_cast<std::size_t>(kBlock * kLanes * dims));
  std::uint32_t pixel = 0;
  double ours = 0, theirs = 0;
  for (auto _ : state) {
    const double start = seconds_now();
    plain(dims, count, pixel, out);
    benchmark::DoNotOptimize(out.data());
    benchmark::ClobberMemory();
    const double middle = seconds_now();
    sampler->prepare({count, &layout, stream_key(1, name, "run"), pixel++, 0, false});
    for (std::uint32_t begin = 0; begin < count; begin += kBlock) {
      block.reset(dims, kBlock, false);
      sampler->fill(begin, block);
      benchmark::DoNotOptimize(block.high(0));
      benchmark::ClobberMemory();
    }
    const double end = seconds_now();
    theirs += middle - start;
    ours += end - middle;
    state.SetIterationTime(end - middle);
  }
  state.SetItemsProcessed(state.iterations() * count * kLanes);
  state.counters["ratio"] = theirs / ours;
  unsetenv("HALFSLOPE_ISA");
}

}  // namespace
}  // namespace halfslope

int main(int argc, char** argv) {
  using namespace halfslope;
  for (const Isa isa : supported_isas()) {
    const auto add = [&](const std::string& name, const std::string& sampler, int dims, std::uint32_t count,
                         Plain plain) {
      benchmark::RegisterBenchmark(
          (name + "/" + std::to_string(count) + "/" + to_string(isa)).c_str(),
          [=](benchmark::State& state) { against(state, to_string(isa), sampler, dims, count, plain); })
          ->UseManualTime();
    };
    for (const std::uint32_t count : {1024u, 16384u}) {
      add("sobol-owen-fast/2-D/against-boost", "sobol-owen-fast", 2, count, boost_sobol);
    }
    for (const std::uint32_t count : {1024u, 16384u, 1u << 20}) {
      add("sobol-owen/2-D/against-hash-a-digit", "sobol-owen", 2, count, hash_for_each_digit);
    }
    for (const std::uint32_t count : {1024u, 16384u}) {
      add("halton-owen/base-2/against-digit-by-digit", "halton-owen", 1, count, digit_by_digit);
      add("halton-owen/2-D/against-digit-by-digit", "halton-owen", 2, count, digit_by_digit);
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
