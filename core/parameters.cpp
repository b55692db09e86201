#include "core/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"

namespace halfslope {
namespace {

// A finite decimal number, all of the text, whatever the locale.
std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = status == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace

int Parameters::whole(const std::string& subject, const std::string& name, int least, int most) const {
  const double value = number(name);
  if (!(value >= least && value <= most && value == std::trunc(value))) {
    fail(ExitCode::kBadInput, "{}: {} must be a whole number from {} to {}, found {}", subject, name, least, most,
         value);
  }
  return static_cast<int>(value);
}

SplitName split_name(std::string_view name) {
  const std::size_t colon = name.find(':');
  if (colon == std::string_view::npos) return {name, std::nullopt};
  return {name.substr(0, colon), name.substr(colon + 1)};
}

Parameters parse_parameters(const std::string& subject, std::optional<std::string_view> text,
                            std::span<const Parameter> allowed) {
  std::vector<std::string> names;
  for (const Parameter& parameter : allowed) names.push_back(parameter.name);
  std::map<std::string, double> values;
  if (text && text->empty()) fail(ExitCode::kBadInput, "{}: nothing stands after ':'", subject);
  if (text && names.empty()) fail(ExitCode::kBadInput, "{}: it takes no parameters", subject);
  std::string_view rest = text.value_or("");
  if (rest.ends_with(',')) fail(ExitCode::kBadInput, "{}: nothing stands after the last ','", subject);
  while (!rest.empty()) {
    const std::string item(rest.substr(0, rest.find(',')));
    rest.remove_prefix(std::min(rest.size(), item.size() + 1));
    const auto equals = item.find('=');
    const std::string name = item.substr(0, equals);
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      fail(ExitCode::kBadInput, "{}: there is no parameter '{}'{}; allowed: {}", subject, name,
           did_you_mean(name, names), fmt::join(names, ", "));
    }
    const std::string number = equals == std::string::npos ? "" : item.substr(equals + 1);
    const auto value = parse_number(number);
    if (!value) fail(ExitCode::kBadInput, "{}: parameter '{}' must be a number, found '{}'", subject, name, number);
    if (!values.emplace(name, *value).second)
      fail(ExitCode::kBadInput, "{}: parameter '{}' stands twice", subject, name);
  }
  for (const Parameter& parameter : allowed) {
    if (values.contains(parameter.name)) continue;
    if (!parameter.fallback) {
      fail(ExitCode::kBadInput, "{}: parameter '{}' is missing; it takes {}", subject, parameter.name,
           fmt::join(names, ", "));
    }
    values.emplace(parameter.name, *parameter.fallback);
  }
  return Parameters(std::move(values));
}

}  // namespace halfslope
