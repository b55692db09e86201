#include "experiments/stopping_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

namespace halfslope {
namespace {

constexpr double kLongestBudget = 1000 * 3600.0;

void skip_blanks(std::string_view& text) { text.remove_prefix(std::min(text.find_first_not_of(' '), text.size())); }

// Takes `word` off the front, and the blanks before it; whether it was there.
bool take(std::string_view& text, std::string_view word) {
  skip_blanks(text);
  if (!text.starts_with(word)) return false;
  text.remove_prefix(word.size());
  return true;
}

std::optional<double> take_number(std::string_view& text) {
  skip_blanks(text);
  double number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number, std::chars_format::fixed);
  if (error != std::errc{}) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(rest - text.data()));
  return number;
}

bool at_end(std::string_view text) {
  skip_blanks(text);
  return text.empty();
}

}  // namespace

std::optional<double> parse_target(std::string_view text) {
  if (!take(text, "rmse") || text.empty()) return std::nullopt;
  if (!take(text, "±")) take(text, "+-");
  const std::optional<double> percent = take_number(text);
  if (!percent || !take(text, "%") || !at_end(text) || !(*percent > 0 && *percent < 100)) return std::nullopt;
  return *percent / 100;
}

std::optional<double> parse_budget(std::string_view text) {
  const std::optional<double> number = take_number(text);
  if (!number) return std::nullopt;
  const double unit = take(text, "s") ? 1 : take(text, "min") ? 60 : take(text, "h") ? 3600 : 0;
  const double seconds = *number * unit;
  if (!at_end(text) || !(seconds > 0 && seconds <= kLongestBudget)) return std::nullopt;
  return seconds;
}

std::string target_text(double target) { return fmt::format("rmse ±{:.10g}%", 100 * target); }
std::string budget_text(double seconds) { return fmt::format("{:.10g} s", seconds); }

int stages_per_doubling(const Spec& spec) { return spec.budget ? 4 : 1; }

}  // namespace halfslope
