// A table read back, by a reader of its own.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/atomic_file.h"

namespace halfslope {

class CsvTable {
 public:
  using Row = std::vector<std::string>;

  explicit CsvTable(const std::string& text) {
    Row row(1);
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (quoted) {
        const bool doubled = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
        if (c != '"' || doubled) row.back() += c;
        if (doubled) ++i;
        quoted = c != '"' || doubled;
      } else if (c == '"') {
        quoted = true;
      } else if (c == ',') {
        row.emplace_back();
      } else if (c == '\n') {
        rows_.push_back(std::move(row));
        row = Row(1);
      } else {
        row.back() += c;
      }
    }
    if (rows_.empty() || quoted || row != Row(1)) throw std::runtime_error("not a whole table: " + text);
    columns_ = rows_.front();
    rows_.erase(rows_.begin());
    for (const Row& r : rows_) {
      if (r.size() != columns_.size()) throw std::runtime_error("a row of another length: " + r.front());
    }
  }
  static CsvTable read(const std::filesystem::path& path) { return CsvTable(read_file(path)); }

  const Row& columns() const { return columns_; }
  std::size_t size() const { return rows_.size(); }
  const Row& row(std::size_t r) const { return rows_.at(r); }
  const std::string& text(std::size_t r, const std::string& column) const {
    for (std::size_t c = 0; c < columns_.size(); ++c) {
      if (columns_[c] == column) return rows_.at(r)[c];
    }
    throw std::runtime_error("no column " + column);
  }
  double number(std::size_t r, const std::string& column) const {
    const std::string& cell = text(r, column);
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (cell.empty() || *end != '\0') throw std::runtime_error(column + " is no number: '" + cell + "'");
    return value;
  }

 private:
  Row columns_;
  std::vector<Row> rows_;
};

}  // namespace halfslope
