#include "analysis/axes.h"

#include <algorithm>
#include <cmath>

#include "analysis/palette.h"
#include "analysis/typeface.h"
#include "core/assertion.h"
#include "core/numbers.h"

namespace halfslope {
namespace {

constexpr double kTickLength = 3;

// Rounded to 12 digits, so that 3 · 0.1 is 0.3.
std::string round_label(double value) {
  if (value == 0) return "0";
  const double unit = std::pow(10, 11 - std::floor(std::log10(std::fabs(value))));
  const double rounded = std::round(value * unit) / unit;
  std::string label = format_number(rounded);
  return label.starts_with('-') ? "\u2212" + label.substr(1) : label;
}

// Within rounding errors of the range's ends.
bool inside(double value, double lo, double hi) {
  const double slack = 1e-9 * (std::fabs(lo) + std::fabs(hi));
  return value >= lo - slack && value <= hi + slack;
}

std::vector<Tick> one_two_five(double lo, double hi) {
  std::vector<Tick> ticks;
  for (int k = static_cast<int>(std::floor(std::log10(lo))); k <= std::ceil(std::log10(hi)); ++k) {
    for (const int digit : {1, 2, 5}) {
      const double value = digit * std::pow(10, k);
      if (inside(value, lo, hi)) ticks.push_back({value, round_label(value)});
    }
  }
  return ticks;
}

}  // namespace

double Scale::fraction(double value) const {
  return log ? std::log(value / lo) / std::log(hi / lo) : (value - lo) / (hi - lo);
}

std::string power_label(int base, int exponent) {
  static constexpr const char* kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string label = std::to_string(base) + (exponent < 0 ? "⁻" : "");
  for (const char digit : std::to_string(std::abs(exponent))) label += kDigits[digit - '0'];
  return label;
}

std::vector<Tick> log_ticks(double lo, double hi, int base, int most_labels) {
  assert_equal(lo > 0 && lo < hi, true, "a logarithmic range");
  const double log_base = std::log(base);
  const int first = static_cast<int>(std::ceil(std::log(lo) / log_base - 1e-9));
  const int last = static_cast<int>(std::floor(std::log(hi) / log_base + 1e-9));
  if (base == 10 && last - first < 1) {
    std::vector<Tick> ticks = one_two_five(lo, hi);
    return ticks.size() >= 2 ? ticks : linear_ticks(lo, hi, most_labels);
  }
  int step = 1;
  while ((last - first) / step + 1 > std::max(most_labels, 2)) ++step;
  std::vector<Tick> ticks;
  for (int k = first; k <= last; ++k) {
    // Multiples of the step, so that 10⁰ has a label wherever it is one of several.
    const bool labelled = (k % step + step) % step == (step > last - first ? (first % step + step) % step : 0);
    ticks.push_back({std::pow(base, k), labelled ? power_label(base, k) : ""});
  }
  // Their crowding towards a power is how a reader sees that a scale is logarithmic.
  for (int k = first - 1; base == 10 && last - first <= 3 && k <= last; ++k) {
    for (int digit = 2; digit <= 9; ++digit) {
      const double value = digit * std::pow(10, k);
      if (inside(value, lo, hi)) ticks.push_back({value, ""});
    }
  }
  return ticks;
}

std::vector<Tick> linear_ticks(double lo, double hi, int most_labels) {
  assert_equal(lo < hi, true, "a range");
  double step = std::pow(10, std::floor(std::log10((hi - lo) / std::max(most_labels, 2))));
  for (int k = 0; std::floor(hi / step + 1e-9) - std::ceil(lo / step - 1e-9) + 1 > most_labels && k < 6; ++k) {
    step *= k % 3 == 1 ? 2.5 : 2;
  }
  std::vector<Tick> ticks;
  for (double k = std::ceil(lo / step - 1e-9); k <= std::floor(hi / step + 1e-9); ++k) {
    ticks.push_back({k * step + 0.0, round_label(k * step)});
  }
  return ticks;
}

Position Axes::at(double x_value, double y_value) const {
  return {top_left.x + width * x.scale.fraction(x_value), top_left.y + height * (1 - y.scale.fraction(y_value))};
}

void Axes::draw_grid(Canvas& canvas) const {
  const Stroke stroke = {kInkLightGrey, 0.4};
  const double right = top_left.x + width, bottom = top_left.y + height;
  for (const Tick& tick : x.ticks) {
    const double px = top_left.x + width * x.scale.fraction(tick.value);
    if (!tick.label.empty()) canvas.line({{px, top_left.y}, {px, bottom}}, stroke);
  }
  for (const Tick& tick : y.ticks) {
    const double py = bottom - height * y.scale.fraction(tick.value);
    if (!tick.label.empty()) canvas.line({{top_left.x, py}, {right, py}}, stroke);
  }
}

void Axes::draw_frame(Canvas& canvas) const {
  const Stroke stroke = {kBlack, 0.6};
  const double bottom = top_left.y + height;
  for (const Tick& tick : x.ticks) {
    const double px = top_left.x + width * x.scale.fraction(tick.value);
    canvas.line({{px, bottom}, {px, bottom + (tick.label.empty() ? 0.6 : 1) * kTickLength}}, stroke);
    if (tick.label.empty()) continue;
    canvas.text({px, bottom + kTickLength + kSmallSize}, tick.label, {.size = kSmallSize, .anchor = Anchor::kMiddle});
  }
  for (const Tick& tick : y.ticks) {
    const double py = bottom - height * y.scale.fraction(tick.value);
    canvas.line({{top_left.x - (tick.label.empty() ? 0.6 : 1) * kTickLength, py}, {top_left.x, py}}, stroke);
    if (tick.label.empty()) continue;
    canvas.text({top_left.x - kTickLength - 1.5, py + 0.36 * kSmallSize}, tick.label,
                {.size = kSmallSize, .anchor = Anchor::kEnd});
  }
  canvas.rectangle(top_left, width, height, {.stroke = stroke});
  canvas.text({top_left.x + width / 2, bottom + kHeightOfXAxis - 1.5}, x.label,
              {.size = kLabelSize, .anchor = Anchor::kMiddle});
  if (!y.label.empty()) {
    canvas.text({top_left.x - width_of_y_axis(y) + 0.8 * kLabelSize + 1, top_left.y + height / 2}, y.label,
                {.size = kLabelSize, .anchor = Anchor::kMiddle, .degrees = 90});
  }
}

double width_of_y_axis(const Axis& y) {
  double widest = 0;
  for (const Tick& tick : y.ticks) widest = std::max(widest, text_width(tick.label, kSmallSize));
  return widest + kTickLength + 1.5 + (y.label.empty() ? 0 : 1.3 * kLabelSize + 2);
}

void draw_slope_guide(Canvas& canvas, const Axes& axes, double x, double y, double slope, const std::string& label) {
  const Stroke stroke = {kInkGrey, 0.5, {1, 1.6}};
  const double y_at_right = y * std::pow(axes.x.scale.hi / x, slope);
  const bool leaves_below = y_at_right < axes.y.scale.lo;
  const double end_x = leaves_below ? x * std::pow(axes.y.scale.lo / y, 1 / slope) : axes.x.scale.hi;
  const Position end = axes.at(end_x, leaves_below ? axes.y.scale.lo : y_at_right);
  canvas.line({axes.at(x, y), end}, stroke);
  if (!leaves_below) {
    canvas.text({end.x + 2, end.y + 0.36 * kSmallSize}, label, {.size = kSmallSize, .ink = kInkGrey});
    return;
  }
  // Left of the line where it is as high as the text: convergence seldom goes there.
  const Position begin = axes.at(x, y);
  const double run = (end.x - begin.x) / (end.y - begin.y);
  canvas.text({end.x - run * (kSmallSize + 2) - 2, end.y - 3}, label,
              {.size = kSmallSize, .anchor = Anchor::kEnd, .ink = kInkGrey});
}

}  // namespace halfslope
