#include "core/kernel_library.h"

#include <dlfcn.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <mutex>

#include "core/error.h"
#include "core/installed_folders.h"

namespace halfslope {
namespace {

constexpr std::array kIsas = {Isa::kScalar, Isa::kBaseline, Isa::kAvx2, Isa::kAvx512};

bool runs(Isa isa) {
  __builtin_cpu_init();
  switch (isa) {
    case Isa::kBaseline:
      return true;
    case Isa::kScalar:
    case Isa::kAvx2:
      return __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    case Isa::kAvx512:
      return runs(Isa::kAvx2) && __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
             __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
             __builtin_cpu_supports("avx512vl");
  }
  return false;
}

std::vector<std::filesystem::path> kernel_folders() {
  const std::filesystem::path libdir = HALFSLOPE_INSTALL_LIBDIR;
  return installed_folders("HALFSLOPE_KERNELS", "kernels", {"lib/halfslope", libdir.filename() / "halfslope"},
                           libdir / "halfslope");
}

void* open_library(Isa isa) {
  const std::string file = "halfslope-kernels-" + to_string(isa) + ".so";
  std::string tried;
  for (const auto& folder : kernel_folders()) {
    const auto path = folder / file;
    if (std::filesystem::exists(path)) {
      if (void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL)) return library;
      fail(ExitCode::kIo, "{}: cannot be opened: {}", path.string(), dlerror());
    }
    tried += "\n  " + path.string();
  }
  fail(ExitCode::kIo, "the kernels for {} were not found; set HALFSLOPE_KERNELS to their folder. Tried:{}",
       to_string(isa), tried);
}

}  // namespace

std::string to_string(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
      return "scalar";
    case Isa::kBaseline:
      return "baseline";
    case Isa::kAvx2:
      return "avx2";
    case Isa::kAvx512:
      return "avx512";
  }
  return "?";
}

std::vector<Isa> supported_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : kIsas) {
    if (runs(isa)) isas.push_back(isa);
  }
  return isas;
}

Isa active_isa() {
  if (const char* asked = std::getenv("HALFSLOPE_ISA"); asked && *asked) {
    std::vector<std::string> names;
    for (const Isa isa : kIsas) {
      if (names.emplace_back(to_string(isa)) != asked) continue;
      if (!runs(isa)) fail(ExitCode::kBadInput, "HALFSLOPE_ISA={}: this processor cannot run it", asked);
      return isa;
    }
    fail(ExitCode::kUsage, "HALFSLOPE_ISA={}: allowed: scalar, baseline, avx2, avx512{}", asked,
         did_you_mean(asked, names));
  }
  return supported_isas().back();
}

std::string isa_class(Isa isa) {
  // The scalar build takes its exp, log and pow from the C library, so it is a class of its own.
  return isa == Isa::kAvx2 || isa == Isa::kAvx512 ? "fma" : to_string(isa);
}

const void* kernel_table(Isa isa, const char* symbol) {
  static std::mutex mutex;
  static std::array<void*, kIsas.size()> libraries = {};
  const std::lock_guard lock(mutex);
  void*& library = libraries[static_cast<std::size_t>(isa)];
  if (!library) library = open_library(isa);
  using Entry = const void* (*)();
  const auto entry = reinterpret_cast<Entry>(dlsym(library, symbol));
  if (!entry) fail(ExitCode::kIo, "the kernels for {} are of another version: no {}", to_string(isa), symbol);
  return entry();
}

}  // namespace halfslope
