// Tables as text.
#pragma once

#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "core/numbers.h"

namespace halfslope {

/// Builds an RFC 4180 table in memory: a header, then rows of as many cells. Text with a comma, a quote, CR or LF is
/// quoted, with quotes doubled. Numbers are format_number's, an empty optional is an empty cell.
///
/// Unlike RFC 4180, and like every Unix tool, a line ends with LF alone. A row with the wrong number of cells is a
/// programmer's error and aborts.
class CsvWriter {
 public:
  explicit CsvWriter(std::span<const std::string_view> columns);
  explicit CsvWriter(std::span<const std::string> columns);
  CsvWriter(std::initializer_list<std::string_view> columns)
      : CsvWriter(std::span<const std::string_view>(columns.begin(), columns.size())) {}

  CsvWriter& cell(std::string_view value);
  CsvWriter& cell(double value) { return raw_cell(format_number(value)); }
  template <std::integral T>
  requires(!std::same_as<T, bool> && !std::same_as<T, char>) CsvWriter& cell(T value) {
    return raw_cell(format_number(value));
  }
  CsvWriter& cell(const std::optional<double>& value) { return value ? cell(*value) : empty_cell(); }
  CsvWriter& empty_cell() { return cell(std::string_view()); }
  void end_row();

  /// A whole row at once.
  template <class... Values>
  void row(const Values&... values) {
    (cell(values), ...);
    end_row();
  }

  /// Every row ended so far, header first.
  const std::string& text() const&;
  std::string text() &&;
  /// The text so far, which is forgotten: rows go on without a header, so that a long table need not be in memory.
  std::string take_text();

 private:
  CsvWriter& raw_cell(std::string_view value);

  std::size_t columns_ = 0, cells_in_row_ = 0;
  std::string text_;
};

}  // namespace halfslope
