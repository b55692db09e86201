#include "analysis/radix_sort.h"

#include <algorithm>
#include <array>
#include <bit>

namespace halfslope {
namespace {

constexpr int kDigit = 11;
constexpr std::size_t kDigits = std::size_t{1} << kDigit;

// Stable by the `digits` digits from bit `shift` on.
void sort_digits(std::vector<KeyedPoint>& points, std::vector<KeyedPoint>& other, int shift, int digits) {
  for (int d = 0; d < digits; ++d, shift += kDigit) {
    const auto digit = [shift](const KeyedPoint& p) { return (p.key >> shift) & (kDigits - 1); };
    std::array<std::uint32_t, kDigits> places = {};
    for (const KeyedPoint& p : points) ++places[digit(p)];
    std::uint32_t place = 0;
    for (std::uint32_t& start : places) {
      const std::uint32_t many = start;
      start = place;
      place += many;
    }
    for (const KeyedPoint& p : points) other[places[digit(p)]++] = p;
    points.swap(other);
  }
}

// False, with the points in some order, where it would take more than about two moves a point.
bool sort_by_insertion(std::vector<KeyedPoint>& points) {
  std::size_t moves = 2 * points.size();
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (points[i - 1].key <= points[i].key) continue;
    const KeyedPoint inserted = points[i];
    std::size_t k = i;
    for (; k > 0 && points[k - 1].key > inserted.key; --k) {
      points[k] = points[k - 1];
      if (--moves == 0) {
        points[k - 1] = inserted;
        return false;
      }
    }
    points[k] = inserted;
  }
  return true;
}

}  // namespace

void radix_sort(std::vector<KeyedPoint>& points) {
  const auto before = [](const KeyedPoint& a, const KeyedPoint& b) { return a.key < b.key; };
  if (points.size() < kDigits / 2) {
    std::stable_sort(points.begin(), points.end(), before);
    return;
  }
  std::uint64_t largest = 0;
  for (const KeyedPoint& p : points) largest = std::max(largest, p.key);
  const int bits = static_cast<int>(std::bit_width(largest)), all = (bits + kDigit - 1) / kDigit;
  // So many digits that of N uniform keys few share them: 2^(11 digits) ≥ 16 N.
  const int some = std::min(all, (static_cast<int>(std::bit_width(points.size())) + 4 + kDigit - 1) / kDigit);
  std::vector<KeyedPoint> other(points.size());
  sort_digits(points, other, std::max(bits - some * kDigit, 0), some);
  if (!sort_by_insertion(points)) std::stable_sort(points.begin(), points.end(), before);
}

}  // namespace halfslope
