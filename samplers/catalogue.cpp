#include "samplers/catalogue.h"

#include "core/assertion.h"
#include "core/error.h"
#include "samplers/antithetic.h"
#include "samplers/best_candidate.h"
#include "samplers/correlated_multi_jittered.h"
#include "samplers/faure.h"
#include "samplers/file_points.h"
#include "samplers/halton.h"
#include "samplers/halton_owen.h"
#include "samplers/hammersley.h"
#include "samplers/hammersley_owen.h"
#include "samplers/held_pairs.h"
#include "samplers/independent.h"
#include "samplers/jittered.h"
#include "samplers/kronecker.h"
#include "samplers/lattice.h"
#include "samplers/multi_jittered.h"
#include "samplers/n_rooks.h"
#include "samplers/orthogonal_array.h"
#include "samplers/pmj.h"
#include "samplers/pmj02.h"
#include "samplers/poisson_disk.h"
#include "samplers/regular.h"
#include "samplers/sobol.h"
#include "samplers/sobol_owen.h"
#include "samplers/stratified.h"

namespace halfslope {

// The menu. To add a sampler: derive from Sampler in a file of its own, say in info() what it is, and add its maker
// here (an embedder calls add() instead, and touches nothing of ours). Samplers that are named with an argument, such
// as a path, are a family.
SamplerCatalogue SamplerCatalogue::built_in() {
  SamplerCatalogue catalogue;
  catalogue.add(make_independent);
  catalogue.add(make_antithetic);
  catalogue.add(make_regular);
  catalogue.add(make_stratified);
  catalogue.add(make_jittered);
  catalogue.add(make_n_rooks);
  catalogue.add(make_orthogonal_array);
  catalogue.add(make_multi_jittered);
  catalogue.add(make_correlated_multi_jittered);
  catalogue.add(make_halton);
  catalogue.add(make_halton_cp);
  catalogue.add(make_halton_owen);
  catalogue.add(make_hammersley);
  catalogue.add(make_hammersley_cp);
  catalogue.add(make_hammersley_owen);
  catalogue.add(make_faure);
  catalogue.add(make_faure_owen);
  catalogue.add(make_sobol);
  catalogue.add(make_sobol_xor);
  catalogue.add(make_sobol_cp);
  catalogue.add(make_sobol_owen);
  catalogue.add(make_sobol_owen_fast);
  catalogue.add(make_pmj);
  catalogue.add(make_pmj02);
  catalogue.add(make_lattice);
  catalogue.add(make_lattice_tent);
  catalogue.add(make_kronecker);
  catalogue.add(make_poisson_disk);
  catalogue.add(make_best_candidate);
  catalogue.add_family(padded_family_info(), make_padded);
  add_file_points(catalogue);
  return catalogue;
}

void SamplerCatalogue::add(Make make) {
  SamplerInfo info = make()->info();
  assert_equal(has(info.name), false, "a sampler of that name");
  entries_.push_back({std::move(info), [make](const std::string&, const SamplerCatalogue&) { return make(); }, false});
}

void SamplerCatalogue::add_family(SamplerInfo info, MakeOne make) {
  assert_equal(has(info.name), false, "samplers of that prefix");
  entries_.push_back({std::move(info), std::move(make), true});
}

const SamplerCatalogue::Entry* SamplerCatalogue::find(const std::string& name) const {
  const std::size_t colon = name.find(':');
  for (const Entry& entry : entries_) {
    // A family is found by its prefix, colon included.
    const bool found =
        entry.family ? colon != std::string::npos && entry.info.name.compare(0, colon + 1, name, 0, colon + 1) == 0
                     : entry.info.name == name;
    if (found) return &entry;
  }
  return nullptr;
}

bool SamplerCatalogue::has(const std::string& name) const { return find(name) != nullptr; }

std::unique_ptr<Sampler> SamplerCatalogue::make(const std::string& name) const {
  if (const Entry* entry = find(name)) return entry->make(name.substr(name.find(':') + 1), *this);
  fail(ExitCode::kBadInput, "there is no sampler '{}'{} (`halfslope list samplers` names them all)", name,
       did_you_mean(name, names()));
}

std::vector<SamplerInfo> SamplerCatalogue::list() const {
  std::vector<SamplerInfo> list;
  for (const Entry& entry : entries_) list.push_back(entry.info);
  return list;
}

std::vector<std::string> SamplerCatalogue::names() const {
  std::vector<std::string> names;
  for (const Entry& entry : entries_) names.push_back(entry.info.name);
  return names;
}

}  // namespace halfslope
