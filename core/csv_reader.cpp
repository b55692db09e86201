#include "core/csv_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <utility>

#include "core/atomic_file.h"
#include "core/error.h"

namespace halfslope {
namespace {

/// Splits a text into rows of cells.
class Scanner {
 public:
  Scanner(std::string_view text, const std::string& name) : text_(text), name_(name) {}
  bool at_end() const { return at_ >= text_.size(); }
  std::size_t line() const { return line_; }

  std::vector<std::string> row() {
    std::vector<std::string> cells;
    do cells.push_back(cell());
    while (take(','));
    if (!at_end() && !take_line_end()) fail(ExitCode::kBadInput, "{}:{}: text after a closing quote", name_, line_);
    return cells;
  }

 private:
  bool take(char c) {
    if (at_end() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  bool take_line_end() {
    if (text_.substr(at_, 2) == "\r\n") ++at_;
    if (!take('\n')) return false;
    ++line_;
    return true;
  }
  std::string cell() {
    if (take('"')) return quoted_cell();
    std::string value;
    while (!at_end() && text_[at_] != ',' && text_[at_] != '\n' && text_.substr(at_, 2) != "\r\n") {
      if (text_[at_] == '"') fail(ExitCode::kBadInput, "{}:{}: a quote inside a cell that is not quoted", name_, line_);
      value += text_[at_++];
    }
    return value;
  }
  std::string quoted_cell() {
    const std::size_t opened = line_;
    std::string value;
    while (!at_end()) {
      const char c = text_[at_++];
      if (c == '"' && !take('"')) return value;
      if (c == '\n') ++line_;
      value += c;
    }
    fail(ExitCode::kBadInput, "{}:{}: a quoted cell does not end", name_, opened);
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0, line_ = 1;
};

}  // namespace

CsvReader::CsvReader(std::string_view text, std::string name) : name_(std::move(name)) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text.starts_with(kByteOrderMark)) text.remove_prefix(kByteOrderMark.size());
  Scanner scanner(text, name_);
  if (scanner.at_end()) fail(ExitCode::kBadInput, "{}: is empty; a header is needed", name_);
  columns_ = scanner.row();
  while (!scanner.at_end()) {
    Row row{scanner.line(), scanner.row()};
    if (row.cells == std::vector<std::string>{""} && columns_.size() > 1) continue;
    if (row.cells.size() != columns_.size()) {
      fail(ExitCode::kBadInput, "{}:{}: found {} cells, the header has {}", name_, row.line, row.cells.size(),
           columns_.size());
    }
    rows_.push_back(std::move(row));
  }
}

CsvReader CsvReader::open(const std::filesystem::path& path) { return {read_file(path), path.string()}; }

std::size_t CsvReader::index(std::string_view column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end()) {
    fail(ExitCode::kBadInput, "{}:1: there is no column '{}'{}", name_, column, did_you_mean(column, columns_));
  }
  return static_cast<std::size_t>(found - columns_.begin());
}

const std::string& CsvReader::text(std::size_t row, std::string_view column) const {
  return rows_.at(row).cells[index(column)];
}

std::optional<double> CsvReader::number(std::size_t row, std::string_view column) const {
  const std::string& cell = text(row, column);
  if (cell.empty()) return std::nullopt;
  double value = 0;
  const char* end = cell.data() + cell.size();
  const auto result = std::from_chars(cell.data(), end, value);
  if (result.ec != std::errc() || result.ptr != end || !std::isfinite(value)) {
    fail(ExitCode::kBadInput, "{}:{}: column '{}': found '{}'; a finite number is allowed", name_, rows_[row].line,
         column, cell);
  }
  return value;
}

double CsvReader::required_number(std::size_t row, std::string_view column) const {
  const auto value = number(row, column);
  if (!value) fail(ExitCode::kBadInput, "{}:{}: column '{}' is empty", name_, rows_[row].line, column);
  return *value;
}

}  // namespace halfslope
