#include "core/csv.h"

#include <utility>

#include "core/assertion.h"

namespace halfslope {

CsvWriter::CsvWriter(std::span<const std::string_view> columns) : columns_(columns.size()) {
  for (const std::string_view column : columns) cell(column);
  end_row();
}

CsvWriter::CsvWriter(std::span<const std::string> columns) : columns_(columns.size()) {
  for (const std::string& column : columns) cell(column);
  end_row();
}

CsvWriter& CsvWriter::cell(std::string_view value) {
  // The lone empty cell of a one-column table is quoted too: a blank line would be no row at all to most readers.
  const bool blank_line = value.empty() && columns_ == 1;
  if (!blank_line && value.find_first_of(",\"\r\n") == std::string_view::npos) return raw_cell(value);
  std::string quoted = "\"";
  for (const char c : value) quoted.append(c == '"' ? 2 : 1, c);
  return raw_cell(quoted += '"');
}

CsvWriter& CsvWriter::raw_cell(std::string_view value) {
  if (cells_in_row_++ > 0) text_ += ',';
  text_ += value;
  return *this;
}

void CsvWriter::end_row() {
  assert_equal(cells_in_row_, columns_, "cells in a row of a table");
  cells_in_row_ = 0;
  text_ += '\n';
}

const std::string& CsvWriter::text() const& {
  assert_equal(cells_in_row_, std::size_t{0}, "cells in a row not ended");
  return text_;
}

std::string CsvWriter::text() && {
  assert_equal(cells_in_row_, std::size_t{0}, "cells in a row not ended");
  return std::move(text_);
}

std::string CsvWriter::take_text() {
  assert_equal(cells_in_row_, std::size_t{0}, "cells in a row not ended");
  return std::exchange(text_, {});
}

}  // namespace halfslope
