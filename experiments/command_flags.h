// Flags that several commands have: their values, and errors in them as errors of usage.
#pragma once

#include <memory>
#include <string>

#include "core/error.h"
#include "core/integral.h"
#include "experiments/catalogue.h"
#include "experiments/spec.h"

namespace halfslope {

/// What `make` returns. An error in a flag's value is an error of usage that begins with the flag's name.
template <class Make>
auto flag(const char* name, Make make) {
  try {
    return make();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    fail(ExitCode::kUsage, "{}: {}", name, error.what());
  }
}

/// "WIDTH,HEIGHT" of --resolution; null where it is empty.
Catalogue::Resolution parse_resolution(const std::string& text);

/// --precision of a command that takes one at a time.
Precision parse_precision(const std::string& text);

/// The scene of --scene: a file's fault stays the file's (exit 3); an unknown name in a flag is the flag's.
std::unique_ptr<IntegralSource> make_source(const Catalogue& catalogue, const std::string& scene,
                                            const Catalogue::Resolution& resolution);

/// The same as integrals over paths.
std::unique_ptr<IntegralSource> make_path_source(const Catalogue& catalogue, const std::string& scene,
                                                 const Catalogue::Resolution& resolution,
                                                 const Catalogue::PathWishes& wishes);

/// The sampler of a flag, which `flag_name` names: likewise.
std::unique_ptr<Sampler> make_sampler(const Catalogue& catalogue, const std::string& sampler, const char* flag_name);

/// Error(kUsage) that names the nearest legal counts, unless the sampler has `count` points of that layout.
void check_count(const Sampler& sampler, std::uint64_t count, const Layout& layout, const char* flag_name);

/// Error(kUsage) for a --replicate that a sampler with so many replicates does not have.
void check_replicate(const SamplerInfo& sampler, std::uint32_t replicate);

}  // namespace halfslope
