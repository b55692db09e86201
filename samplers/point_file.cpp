#include "samplers/point_file.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>
#include <system_error>
#include <vector>

#include "core/error.h"
#include "core/random.h"
#include "samplers/line_reader.h"

namespace halfslope {
namespace {

constexpr std::uint64_t kOne = std::uint64_t{1} << 53;

bool is_blank(char c) { return c == ' ' || c == '\t'; }
bool is_separator(char c) { return c == ',' || c == ';'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }

void skip_blanks(std::string_view& text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
}

/// Text from a file, fit for a message whatever it is.
std::string shown(std::string_view text) {
  constexpr std::size_t kMost = 40;
  std::string safe = "'";
  for (const char c : text.substr(0, kMost)) {
    const auto byte = static_cast<unsigned char>(c);
    safe += byte >= ' ' && byte < 0x7f ? std::string(1, c) : fmt::format("\\x{:02x}", byte);
  }
  return safe + (text.size() > kMost ? "…'" : "'");
}

/// Whether a number beyond the range of binary64 is a tiny one: the place of its first digit that is not 0 decides.
bool is_tiny(std::string_view number) {
  const std::size_t e = std::min(number.find_first_of("eE"), number.size());
  const std::string_view digits = number.substr(0, e);
  const auto first = static_cast<std::ptrdiff_t>(std::min(digits.find_first_of("123456789"), digits.size()));
  const auto point = static_cast<std::ptrdiff_t>(std::min(digits.find('.'), digits.size()));
  std::ptrdiff_t exponent = 0;
  std::string_view text = number.substr(std::min(e + 1, number.size()));
  const bool negative = text.starts_with('-');
  if (text.starts_with('+') || negative) text.remove_prefix(1);
  if (std::from_chars(text.data(), text.data() + text.size(), exponent).ec == std::errc::result_out_of_range)
    return negative;
  return point - first + (negative ? -exponent : exponent) < 0;
}

/// A line's coordinates, one after the other.
class Row {
 public:
  Row(std::string_view line, const LineReader& reader) : rest_(line), reader_(reader) { skip_blanks(rest_); }
  bool at_end() const { return rest_.empty(); }

  /// The text of the next coordinate.
  std::string_view token() const {
    const auto* end = std::find_if(rest_.begin(), rest_.end(), [](char c) { return is_blank(c) || is_separator(c); });
    return rest_.substr(0, static_cast<std::size_t>(end - rest_.begin()));
  }
  /// Goes past `length` bytes and what separates them from the next coordinate.
  void skip(std::size_t length) {
    rest_.remove_prefix(length);
    skip_blanks(rest_);
    if (!rest_.empty() && is_separator(rest_.front())) rest_.remove_prefix(1);
    skip_blanks(rest_);
    ++index_;
  }
  double number() {
    const char *begin = rest_.data(), *end = begin + rest_.size();
    if (rest_.size() > 1 && *begin == '+' && (is_digit(begin[1]) || begin[1] == '.')) ++begin;
    double value = 0;
    const auto [rest, status] = std::from_chars(begin, end, value);
    if (status == std::errc::invalid_argument || (rest != end && !is_blank(*rest) && !is_separator(*rest))) refuse();
    const auto length = static_cast<std::size_t>(rest - rest_.data());
    if (status == std::errc::result_out_of_range) {
      if (!is_tiny(rest_.substr(0, length))) refuse();
      value = 0;
    }
    if (!std::isfinite(value)) refuse();
    skip(length);
    return value;
  }

 private:
  [[noreturn]] void refuse() const {
    if (token().empty()) {
      fail(ExitCode::kBadInput, "{}: coordinate {} is missing; found {}", reader_.place(), index_ + 1,
           shown(rest_.substr(0, 1)));
    }
    const bool text = std::all_of(token().begin(), token().end(), [](char c) { return c >= ' ' && c < 0x7f; });
    fail(ExitCode::kBadInput, "{}: coordinate {}: found {}; a finite number is allowed{}", reader_.place(), index_ + 1,
         shown(token()), text ? "" : ". Is this a text file?");
  }

  std::string_view rest_;
  const LineReader& reader_;
  std::size_t index_ = 0;
};

/// The number of columns that a line of names has; 0 where it is none.
std::size_t names_in(std::string_view line, const LineReader& reader) {
  std::size_t names = 0;
  for (Row row(line, reader); !row.at_end(); ++names) {
    const std::string_view name = row.token();
    double value = 0;
    const bool number =
        std::from_chars(name.data(), name.data() + name.size(), value).ec != std::errc::invalid_argument;
    if (number || !std::all_of(name.begin(), name.end(), [](char c) { return is_letter(c) || is_digit(c); })) return 0;
    if (name.empty() || !is_letter(name.front())) return 0;
    row.skip(name.size());
  }
  return names;
}

class Reader {
 public:
  Reader(const std::filesystem::path& path, Outside outside, const PointFileLimits& limits)
      : name_(path.string()), outside_(outside), limits_(limits), lines_(path, limits.line) {
    std::error_code error;
    if (std::filesystem::is_regular_file(path, error)) size_ = std::filesystem::file_size(path, error);
    if (error) size_ = 0;
  }

  PointFile read() {
    while (auto line = lines_.next()) {
      constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
      if (lines_.line() == 1 && line->starts_with(kByteOrderMark)) line->remove_prefix(kByteOrderMark.size());
      skip_blanks(*line);
      if (line->empty()) continue;
      if (line->starts_with('#') || line->starts_with("//")) {
        comment_ = true;
      } else if (const std::size_t names = columns_ == 0 ? names_in(*line, lines_) : 0; names > 0) {
        set_columns(names);
      } else {
        add_point(*line);
      }
    }
    if (file_.words.empty()) {
      fail(ExitCode::kBadInput, "{}: holds no points{}; a line for each is needed", name_,
           lines_.line() == 0 ? ", it is empty" : "");
    }
    end_set();
    file_.hash = hash();
    return std::move(file_);
  }

 private:
  void set_columns(std::size_t columns) {
    columns_ = columns;
    columns_line_ = lines_.line();
  }

  void add_point(std::string_view line) {
    if (comment_ && points_ > 0) end_set();
    comment_ = false;
    if (points_++ == 0) set_line_ = lines_.line();
    std::size_t found = 0;
    for (Row row(line, lines_); !row.at_end(); ++found) {
      check_room();
      file_.words.push_back(word(row.number(), found));
    }
    if (columns_ == 0) set_columns(found);
    if (found != columns_) {
      fail(ExitCode::kBadInput, "{}: found {} coordinate{}, line {} has {}", lines_.place(), found,
           found == 1 ? "" : "s", columns_line_, columns_);
    }
  }

  std::uint64_t word(double x, std::size_t index) {
    if (x >= 0 && x < 1) return static_cast<std::uint64_t>(x * 0x1p53);
    ++file_.moved;
    if (outside_ == Outside::kRefuse) {
      fail(ExitCode::kBadInput,
           "{}: coordinate {} is {}, outside [0, 1); `file-wrap:{}` (`measure --wrap`) takes it modulo 1, "
           "`file-clamp:` (`measure --clamp`) moves it to the nearest end",
           lines_.place(), index + 1, x, name_);
    }
    if (outside_ == Outside::kClamp) return x < 0 ? 0 : kOne - 1;
    // Where x − ⌊x⌋ would be rounded, to 1 even, it is cut down: −2⁻⁶⁰ goes to 1 − 2⁻⁵³.
    const double fraction = std::fabs(x) - std::floor(std::fabs(x));
    if (x > 0 || fraction == 0) return static_cast<std::uint64_t>(fraction * 0x1p53);
    return kOne - static_cast<std::uint64_t>(std::ceil(fraction * 0x1p53));
  }

  void end_set() {
    if (file_.sets == 0) {
      file_.count = points_;
      file_.dims = static_cast<int>(columns_);
    }
    ++file_.sets;
    if (points_ != file_.count) {
      fail(ExitCode::kBadInput, "{}:{}: set {} begins here and has {} point{}, the first has {}; they must be alike",
           name_, set_line_, file_.sets, points_, points_ == 1 ? "" : "s", file_.count);
    }
    points_ = 0;
  }

  /// Refuses what will not fit as soon as the file's size tells, and at the latest when it does not.
  void check_room() {
    const std::uint64_t held = file_.words.size();
    const auto in_all = [&] {  // if it goes on as it began
      const double rest = static_cast<double>(size_) / static_cast<double>(lines_.bytes());
      return static_cast<double>(held) * std::max(1.0, rest);
    };
    constexpr std::uint64_t kSample = std::uint64_t{1} << 20;  // bytes that tell how long a coordinate is
    const bool hopeless = !looked_ahead_ && size_ > 0 && lines_.bytes() >= kSample &&
                          in_all() > 2 * static_cast<double>(limits_.coordinates);
    looked_ahead_ |= lines_.bytes() >= kSample;
    if (held < limits_.coordinates && !hopeless) return;
    constexpr double kGiB = 0x1p30;
    const double wanted = in_all();
    fail(ExitCode::kBadInput,
         "{}: too many points: about {:.0f} coordinates, {:.3g} GiB; at most {} ({:.3g} GiB) are read", name_, wanted,
         wanted * sizeof(std::uint64_t) / kGiB, limits_.coordinates,
         static_cast<double>(limits_.coordinates) * sizeof(std::uint64_t) / kGiB);
  }

  std::uint64_t hash() const {
    std::uint64_t h = 0;
    const auto add = [&](std::uint64_t number) {
      char bytes[sizeof number];
      std::memcpy(bytes, &number, sizeof number);
      h = hash_text(std::string_view(bytes, sizeof bytes), h);
    };
    for (const std::uint64_t number : {static_cast<std::uint64_t>(file_.dims), file_.count, file_.sets}) add(number);
    for (const std::uint64_t number : file_.words) add(number);
    return h;
  }

  std::string name_;
  Outside outside_;
  PointFileLimits limits_;
  LineReader lines_;
  std::uint64_t size_ = 0;  ///< bytes of the file; 0 where it is none of a known size
  PointFile file_;
  std::size_t columns_ = 0;
  std::uint64_t columns_line_ = 0;
  std::uint64_t points_ = 0, set_line_ = 0;  ///< of the set that is being read
  bool comment_ = false;                     ///< since the last point
  bool looked_ahead_ = false;
};

}  // namespace

PointFile read_point_file(const std::filesystem::path& path, Outside outside, const PointFileLimits& limits) {
  return Reader(path, outside, limits).read();
}

}  // namespace halfslope
