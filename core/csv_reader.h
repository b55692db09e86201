// Tables read back.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

/// An RFC 4180 table with a header, whole in memory. Lines end with LF or CRLF, the last one's may be missing; a quoted
/// cell may hold commas, line ends and doubled quotes. A byte-order mark before the header is skipped, and so are blank
/// lines, unless the table has one column.
///
/// Every error is Error(kBadInput) that names the file and the line.
class CsvReader {
 public:
  /// `name` is what errors call the text: its file.
  CsvReader(std::string_view text, std::string name);
  /// Of a file; Error(kBadInput) too where there is none.
  static CsvReader open(const std::filesystem::path& path);

  const std::vector<std::string>& columns() const { return columns_; }
  std::size_t size() const { return rows_.size(); }
  const std::string& text(std::size_t row, std::string_view column) const;
  /// Null where the cell is empty; an error where it is not a finite number, locale-free as format_number writes it.
  std::optional<double> number(std::size_t row, std::string_view column) const;
  /// As number(), and an empty cell is an error too.
  double required_number(std::size_t row, std::string_view column) const;

 private:
  struct Row {
    std::size_t line;  ///< that it begins at, from 1
    std::vector<std::string> cells;
  };
  std::size_t index(std::string_view column) const;

  std::string name_;
  std::vector<std::string> columns_;
  std::vector<Row> rows_;
};

}  // namespace halfslope
