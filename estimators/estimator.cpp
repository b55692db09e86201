#include "estimators/estimator.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <string_view>

#include "core/assertion.h"
#include "core/error.h"
#include "estimators/one_sample.h"

namespace halfslope {
namespace {

constexpr int kMostSamples = 64;  // of one round: its terms are held for a whole block
constexpr int kMostTechniques = 16;
constexpr std::string_view kOneSample = "one-sample-", kPathPrefix = "path-";

std::vector<std::string> names_of(std::span<const Technique> techniques) {
  std::vector<std::string> names;
  for (const Technique& t : techniques) names.push_back(t.name);
  return names;
}

std::optional<int> find(std::span<const Technique> techniques, std::string_view name) {
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    if (techniques[i].name == name) return static_cast<int>(i);
  }
  return std::nullopt;
}

template <class Number>
std::optional<Number> parse_number(std::string_view text) {
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Allocation parse_allocation(const std::string& name, std::string_view list, std::span<const Technique> techniques) {
  const auto names = names_of(techniques);
  std::vector<int> counts(techniques.size(), 0);
  while (true) {
    const auto plus = list.find('+');
    const std::string_view item = list.substr(0, plus);
    const auto star = item.find('*');
    const std::string technique(item.substr(0, star));
    const auto index = find(techniques, technique);
    if (!index) {
      fail(ExitCode::kBadInput, "estimator '{}': there is no technique '{}' here{} (this scene has {})", name,
           technique, did_you_mean(technique, names), fmt::join(names, ", "));
    }
    int& count = counts[static_cast<std::size_t>(*index)];
    if (count != 0) fail(ExitCode::kBadInput, "estimator '{}': technique '{}' stands twice", name, technique);
    count = 1;
    if (star != std::string_view::npos) {
      const auto parsed = parse_number<int>(item.substr(star + 1));
      if (!parsed || *parsed < 1 || *parsed > kMostSamples) {
        fail(ExitCode::kBadInput, "estimator '{}': '{}': a count is a whole number from 1 to {}", name, item,
             kMostSamples);
      }
      count = *parsed;
    }
    if (plus == std::string_view::npos) break;
    list.remove_prefix(plus + 1);
  }
  Allocation allocation;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    allocation.techniques.push_back(static_cast<int>(i));
    allocation.counts.push_back(counts[i]);
  }
  if (allocation.round() > kMostSamples || allocation.techniques.size() > kMostTechniques) {
    fail(ExitCode::kBadInput, "estimator '{}': a round takes at most {} samples of {} techniques", name, kMostSamples,
         kMostTechniques);
  }
  return allocation;
}

bool is_lighting(std::span<const Technique> techniques) {
  return find(techniques, "light") && find(techniques, "bsdf");
}

// What a heuristic combines where its name does not say: light+bsdf, or whatever a scene without those two has.
std::string default_techniques(std::span<const Technique> techniques) {
  if (is_lighting(techniques) || techniques.size() == 1) return "light+bsdf";
  return fmt::format("{}", fmt::join(names_of(techniques), "+"));
}

/// The estimator, if it comes to the integral's value: a technique that misses some of it needs weights that know, and
/// another technique that does not.
Estimator checked(Estimator estimator, std::span<const Technique> techniques) {
  const auto misses = [&](int t) { return !techniques[static_cast<std::size_t>(t)].misses.empty(); };
  const auto& drawn = estimator.allocation.techniques;
  const auto some = std::ranges::find_if(drawn, misses);
  if (some == drawn.end()) return estimator;
  const Technique& technique = techniques[static_cast<std::size_t>(*some)];
  if (std::ranges::all_of(drawn, misses)) {
    fail(ExitCode::kBadInput, "estimator '{}' would be biased: {} misses {}; combine it, as balance@{}+bsdf does",
         estimator.name, technique.name, technique.misses, technique.name);
  }
  if (estimator.heuristic.kind == HeuristicKind::kAverage) {
    fail(ExitCode::kBadInput,
         "estimator '{}' would be biased: {} misses {}, which an average weighs by half; take balance", estimator.name,
         technique.name, technique.misses);
  }
  return estimator;
}

}  // namespace

int Allocation::round() const { return one_sample || path ? 1 : std::accumulate(counts.begin(), counts.end(), 0); }

Layout Allocation::layout(std::span<const Technique> catalogue) const {
  if (one_sample) return shared_layout(techniques, catalogue).layout;
  Layout layout;
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    for (int j = 0; j < counts[i]; ++j) layout.append(catalogue[static_cast<std::size_t>(techniques[i])].layout);
  }
  if (!path) return layout;
  layout.append(path->each);
  Layout whole = path->start;
  for (int vertex = 0; vertex < path->vertices; ++vertex) whole.append(layout);
  return whole;
}

// The menu. To add a heuristic: its kind in estimators/kernels.h, its weight in heuristics.h, its line here (an
// embedder calls add() with a weight function instead, and touches nothing of ours).
EstimatorCatalogue EstimatorCatalogue::built_in() {
  const Parameter kExponent = {"the power heuristic's exponent", 0, std::numeric_limits<double>::max(), 2};
  EstimatorCatalogue catalogue;
  catalogue.entries_ = {
      {{"average", "the plain average of the techniques' estimators, w = 1/n", "Veach & Guibas (1995)"},
       "average",
       {HeuristicKind::kAverage},
       std::nullopt},
      {{"balance", "balance heuristic, w_i = c_i p_i / sum c_k p_k", "Veach & Guibas (1995); Veach (1997), eq. 9.8"},
       "balance",
       {HeuristicKind::kBalance},
       std::nullopt},
      {{"power[:B]", "power heuristic with exponent B (default 2)",
        "Veach & Guibas (1995); Veach (1997), section 9.2.3"},
       "power",
       {HeuristicKind::kPower, 2},
       kExponent},
      {{"cutoff[:A]", "balance heuristic without techniques whose c_i p_i is below A times the largest (default 0.1)",
        "Veach & Guibas (1995); Veach (1997), section 9.2.3"},
       "cutoff",
       {HeuristicKind::kCutoff, 0.1},
       Parameter{"the cutoff heuristic's threshold", 0, 1, 0.1}},
      {{"maximum", "each sample to the technique with the largest c_i p_i, a tie to the first",
        "Veach & Guibas (1995); Veach (1997), section 9.2.3"},
       "maximum",
       {HeuristicKind::kMaximum},
       std::nullopt},
      {{"optimal", "optimal weights, negative ones allowed, solved for from the samples they weight; biased at small N",
        "Kondapaneni & others, Optimal multiple importance sampling (2019)"},
       "optimal",
       {HeuristicKind::kOptimal},
       std::nullopt},
      {{"optimal-progressive",
        "optimal weights solved for from the samples before, at 8, 16, 32, ... of each technique",
        "Kondapaneni & others, Optimal multiple importance sampling (2019)"},
       "optimal-progressive",
       {HeuristicKind::kOptimalProgressive},
       std::nullopt},
      {{"one-sample-balance",
        "each sample from one technique, chosen with probability c_i / sum c_k, weighted by balance; N counts samples "
        "(so any heuristic: one-sample-maximum, ...)",
        "Veach & Guibas (1995); Veach (1997), section 9.2.4"},
       "one-sample-balance",
       {HeuristicKind::kBalance},
       std::nullopt},
      {{"one-sample-power[:B]", "the same, weighted by power", "Veach & Guibas (1995); Veach (1997), section 9.2.4"},
       "one-sample-power",
       {HeuristicKind::kPower, 2},
       kExponent},
  };
  return catalogue;
}

void EstimatorCatalogue::add(EstimatorInfo info, WeightFunction weight) {
  for (const EstimatorInfo& taken : list()) {
    assert_equal(taken.name.substr(0, taken.name.find('[')) == info.name, false, "an estimator of that name");
  }
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  const bool plain = !info.name.empty() && info.name.find_first_not_of(kPlain) == std::string::npos;
  assert_equal(plain, true, "a heuristic's name without punctuation");
  assert_equal(weight != nullptr, true, "a heuristic has a weight function");
  const std::string name = info.name;
  entries_.push_back({std::move(info), name, {HeuristicKind::kCustom, 0, weight}, std::nullopt});
}

std::vector<EstimatorInfo> EstimatorCatalogue::list() const {
  std::vector<EstimatorInfo> list = {
      {"mean", "the plain mean of an integrand's values (analytic integrands)",
       "the definition of Monte Carlo integration"},
      {"light", "surface form: a light chosen uniformly, then a point uniform on its area",
       "Veach (1997), section 8.2.2"},
      {"bsdf", "directional form: the BSDF's own density (visible normals for GGX)",
       "Veach (1997), section 8.2.2; Dupuy & Benyoub (2023)"},
      {"hemisphere", "directional form: uniform over the hemisphere", "Veach (1997), section 8.2.2"},
      {"cosine", "directional form: by the cosine with the normal", "Veach (1997), section 8.2.2"},
      {"surface", "surface form: uniform over the area of all surfaces, emitting or not",
       "Veach (1997), section 8.2.2"},
      {"light-power", "as light, with lights chosen in proportion to the power they emit",
       "Shirley, Wang & Zimmerman, Monte Carlo techniques for direct lighting calculations (1996)"},
      {"light-bvh", "as light, with lights chosen by a tree of them, likelier the more they can send to the point",
       "Conty Estevez & Kulla, Importance sampling of many lights with adaptive tree splitting (2018)"},
      {"light-solid-angle",
       "as light, with the point uniform in solid angle on rectangles, triangles and spheres (also "
       "light-power-solid-angle, light-bvh-solid-angle)",
       "Arvo (1995); Urena, Fajardo & King (2013)"},
  };
  list.insert(list.end(),
              {{"path-light", "paths by next event estimation alone; light that it cannot find is added",
                "Kajiya, The rendering equation (1986)"},
               {"path-bsdf", "paths that meet lights by the BSDF's directions alone; delta lights are added",
                "Kajiya, The rendering equation (1986)"},
               {"path-balance",
                "both at every vertex, weighted by balance (so any heuristic: path-average, path-power:3, ...; with "
                "@light-bvh+bsdf and the like for other light techniques); N counts paths",
                "Veach (1997), chapter 9 and section 10.3"}});
  for (const Entry& entry : entries_) list.push_back(entry.info);
  return list;
}

const EstimatorCatalogue::Entry* EstimatorCatalogue::find_entry(std::string_view kind) const {
  const auto found = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& e) { return e.name == kind; });
  return found == entries_.end() ? nullptr : &*found;
}

void EstimatorCatalogue::parse_heuristic(Estimator& estimator, std::string_view text,
                                         std::span<const Technique> techniques) const {
  const std::string& name = estimator.name;
  const auto colon = text.find(':');
  const std::string_view kind = text.substr(0, colon);
  const bool one_sample = kind.starts_with(kOneSample);
  const Entry* entry = find_entry(kind);
  if (!entry && one_sample) entry = find_entry(kind.substr(kOneSample.size()));
  if (entry && one_sample && !is_fold(entry->heuristic.kind)) {
    fail(ExitCode::kBadInput, "estimator '{}': the optimal weights are for samples of every technique", name);
  }
  if (!entry) {
    auto allowed = names_of(techniques);
    for (const Entry& e : entries_) allowed.push_back(e.name);
    fail(ExitCode::kBadInput, "there is no estimator '{}' for this scene{} (it has {})", kind,
         did_you_mean(kind, allowed), fmt::join(allowed, ", "));
  }
  estimator.heuristic = entry->heuristic;
  estimator.allocation.one_sample = one_sample;
  if (colon == std::string_view::npos) return;
  if (!entry->parameter) fail(ExitCode::kBadInput, "estimator '{}': '{}' takes no parameter", name, kind);
  const auto& [meaning, least, most, standard] = *entry->parameter;
  const auto value = parse_number<double>(text.substr(colon + 1));
  if (!value || !std::isfinite(*value) || *value < least || *value > most) {
    const bool bounded = most < std::numeric_limits<double>::max();
    fail(ExitCode::kBadInput, "estimator '{}': {} is a number that is at least {}{}, found '{}'", name, meaning, least,
         bounded ? fmt::format(" and at most {}", most) : "", text.substr(colon + 1));
  }
  estimator.heuristic.parameter = *value;
}

Estimator EstimatorCatalogue::parse(const std::string& name, std::span<const Technique> techniques) const {
  if (const auto technique = find(techniques, name)) {
    return checked({name, {}, {{*technique}, {1}}}, techniques);
  }
  const auto at = name.find('@');
  Estimator estimator;
  estimator.name = name;
  parse_heuristic(estimator, std::string_view(name).substr(0, at), techniques);
  const bool one_sample = estimator.allocation.one_sample;
  const std::string list = at == std::string::npos ? default_techniques(techniques) : name.substr(at + 1);
  estimator.allocation = parse_allocation(name, list, techniques);
  estimator.allocation.one_sample = one_sample;
  // Every heuristic weights a lone technique by 1, and leaves no choice.
  if (estimator.allocation.techniques.size() == 1) {
    estimator.heuristic = {};
    if (one_sample) estimator.allocation = {estimator.allocation.techniques, {1}};
  }
  return checked(std::move(estimator), techniques);
}

Estimator EstimatorCatalogue::parse(const std::string& name, const IntegralSource& source) const {
  if (const PathShape* shape = source.path()) return parse_path(name, source.techniques(), *shape);
  return parse(name, source.techniques());
}

bool is_path_estimator(std::string_view name) { return name.starts_with(kPathPrefix); }

Estimator EstimatorCatalogue::parse_path(const std::string& name, std::span<const Technique> techniques,
                                         const PathShape& shape) const {
  if (!is_path_estimator(name)) {
    fail(ExitCode::kBadInput, "there is no estimator '{}' of paths, whose names begin with '{}'", name, kPathPrefix);
  }
  const std::string_view bare = std::string_view(name).substr(kPathPrefix.size());
  const int bsdf = find(techniques, "bsdf").value();
  const auto pair_with = [&](int light) { return Allocation{{light, bsdf}, {1, 1}, false, shape}; };
  if (const auto technique = find(techniques, bare)) {
    const bool is_light = *technique != bsdf;
    return {name, {HeuristicKind::kOnly, is_light ? 0.0 : 1.0}, pair_with(is_light ? *technique : 0)};
  }
  const auto at = bare.find('@');
  Estimator estimator;
  estimator.name = name;
  try {
    parse_heuristic(estimator, bare.substr(0, at), techniques);
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    std::string_view message = error.what();
    fail(ExitCode::kBadInput, "estimator '{}' of paths: {}", name, message);
  }
  if (!is_fold(estimator.heuristic.kind) || estimator.allocation.one_sample) {
    fail(ExitCode::kBadInput, "estimator '{}': optimal and one-sample weights are for direct lighting, not for paths",
         name);
  }
  estimator.allocation = pair_with(0);
  if (at == std::string_view::npos) return checked(std::move(estimator), techniques);
  const Allocation asked = parse_allocation(name, bare.substr(at + 1), techniques);
  if (asked.techniques.size() != 2 || asked.techniques[1] != bsdf || asked.counts != std::vector{1, 1}) {
    auto lights = names_of(techniques);
    lights.pop_back();
    fail(ExitCode::kBadInput,
         "estimator '{}': a path takes one sample of a light technique ({}) and one of bsdf at each vertex", name,
         fmt::join(lights, ", "));
  }
  estimator.allocation = pair_with(asked.techniques[0]);
  return checked(std::move(estimator), techniques);
}

Estimator parse_estimator(const std::string& name, std::span<const Technique> techniques) {
  return EstimatorCatalogue::built_in().parse(name, techniques);
}

std::vector<std::string> default_estimators(std::span<const Technique> techniques) {
  std::vector<std::string> names = names_of(techniques);
  if (is_lighting(techniques)) names = {"light", "bsdf"};
  if (names.size() > 1) names.insert(names.end(), {"average", "balance", "power"});
  return names;
}

}  // namespace halfslope
