#include "estimators/estimator.h"

#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <string_view>

#include "core/error.h"

namespace halfslope {
namespace {

constexpr int kMostSamples = 64;  // of one round: its terms are held for a whole block
constexpr int kMostTechniques = 16;

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

Heuristic parse_heuristic(const std::string& name, std::string_view text, std::span<const Technique> techniques) {
  const auto colon = text.find(':');
  const std::string kind(text.substr(0, colon));
  const bool has_parameter = colon != std::string_view::npos;
  if (kind == "power") {
    if (!has_parameter) return {HeuristicKind::kPower, 2};
    const auto beta = parse_number<double>(text.substr(colon + 1));
    if (!beta || !std::isfinite(*beta) || *beta < 0) {
      fail(ExitCode::kBadInput,
           "estimator '{}': the power heuristic's exponent is a number that is at least 0, found '{}'", name,
           text.substr(colon + 1));
    }
    return {HeuristicKind::kPower, *beta};
  }
  if (kind == "average" || kind == "balance") {
    if (has_parameter) fail(ExitCode::kBadInput, "estimator '{}': '{}' takes no parameter", name, kind);
    return {kind == "average" ? HeuristicKind::kAverage : HeuristicKind::kBalance, 0};
  }
  auto allowed = names_of(techniques);
  for (const char* heuristic : {"average", "balance", "power"}) allowed.emplace_back(heuristic);
  fail(ExitCode::kBadInput, "there is no estimator '{}' for this scene{} (it has {})", kind,
       did_you_mean(kind, allowed), fmt::join(allowed, ", "));
}

}  // namespace

int Allocation::round() const { return std::accumulate(counts.begin(), counts.end(), 0); }

Layout Allocation::layout(std::span<const Technique> catalogue) const {
  Layout layout;
  for (std::size_t i = 0; i < techniques.size(); ++i) {
    for (int j = 0; j < counts[i]; ++j) layout.append(catalogue[static_cast<std::size_t>(techniques[i])].layout);
  }
  return layout;
}

// The menu. A new heuristic is a kind in estimators/kernels.h, its weight in heuristics.h, its name here and above.
std::vector<EstimatorInfo> estimator_catalogue() {
  return {
      {"mean", "the plain mean of an integrand's values (analytic integrands)",
       "the definition of Monte Carlo integration"},
      {"light", "surface form: a light chosen uniformly, then a point uniform on its area",
       "Veach (1997), section 8.2.2"},
      {"bsdf", "directional form: the BSDF's own density (visible normals for GGX)",
       "Veach (1997), section 8.2.2; Dupuy & Benyoub (2023)"},
      {"average", "the plain average of the techniques' estimators, w = 1/n", "Veach & Guibas (1995)"},
      {"balance", "balance heuristic, w_i = c_i p_i / sum c_k p_k", "Veach & Guibas (1995); Veach (1997), eq. 9.8"},
      {"power[:B]", "power heuristic with exponent B (default 2)", "Veach & Guibas (1995); Veach (1997), eq. 9.9"},
  };
}

Estimator parse_estimator(const std::string& name, std::span<const Technique> techniques) {
  if (const auto technique = find(techniques, name)) return {name, {HeuristicKind::kSingle, 0}, {{*technique}, {1}}};
  const auto at = name.find('@');
  Estimator estimator;
  estimator.name = name;
  estimator.heuristic = parse_heuristic(name, std::string_view(name).substr(0, at), techniques);
  const std::string_view list = at == std::string::npos ? "light+bsdf" : std::string_view(name).substr(at + 1);
  estimator.allocation = parse_allocation(name, list, techniques);
  // Every heuristic weights a lone technique by 1.
  if (estimator.allocation.techniques.size() == 1) estimator.heuristic = {HeuristicKind::kSingle, 0};
  return estimator;
}

}  // namespace halfslope
