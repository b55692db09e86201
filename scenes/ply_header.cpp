#include "scenes/ply_header.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/error.h"
#include "scenes/mesh_readers.h"

namespace halfslope {
namespace {

using Type = PlyHeader::Type;

struct TypeName {
  std::string_view name;
  Type type;
};
constexpr std::array kTypes = {
    TypeName{"char", Type::kInt8},       TypeName{"int8", Type::kInt8},       TypeName{"uchar", Type::kUInt8},
    TypeName{"uint8", Type::kUInt8},     TypeName{"short", Type::kInt16},     TypeName{"int16", Type::kInt16},
    TypeName{"ushort", Type::kUInt16},   TypeName{"uint16", Type::kUInt16},   TypeName{"int", Type::kInt32},
    TypeName{"int32", Type::kInt32},     TypeName{"uint", Type::kUInt32},     TypeName{"uint32", Type::kUInt32},
    TypeName{"float", Type::kFloat32},   TypeName{"float32", Type::kFloat32}, TypeName{"double", Type::kFloat64},
    TypeName{"float64", Type::kFloat64},
};

/// Reads the header line by line.
class HeaderReader {
 public:
  HeaderReader(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  PlyHeader read() {
    if (!next_line() || words_ != std::vector<std::string_view>{"ply"})
      error("the first line is '{}', allowed: ply", shown(line_));
    bool has_format = false;
    while (next_line()) {
      if (words_.empty() || words_[0] == "comment" || words_[0] == "obj_info") continue;
      if (words_[0] == "format") {
        if (has_format) error("a second 'format', allowed: one");
        has_format = true;
        read_format();
      } else if (words_[0] == "element") {
        read_element();
      } else if (words_[0] == "property") {
        read_property();
      } else if (words_[0] == "end_header" && words_.size() == 1) {
        if (!has_format) error("the header has no 'format', allowed: one");
        header_.bytes = at_;
        header_.lines = number_;
        return header_;
      } else {
        error("'{}' in the header, allowed: format, comment, obj_info, element, property, end_header", shown(line_));
      }
    }
    error("the file ends in its header, allowed: 'end_header' first");
  }

 private:
  template <class... Args>
  [[noreturn]] void error(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ExitCode::kBadInput, "{}:{}: {}", file_, std::max<std::size_t>(number_, 1),
         fmt::format(format, std::forward<Args>(args)...));
  }

  bool next_line() {
    if (at_ == text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    at_ = std::min(end + 1, text_.size());
    ++number_;
    words_.clear();
    for (std::size_t begin = 0; begin < line_.size();) {
      const std::size_t word = line_.find_first_not_of(" \t", begin);
      if (word == std::string_view::npos) break;
      begin = std::min(line_.find_first_of(" \t", word), line_.size());
      words_.push_back(line_.substr(word, begin - word));
      if (words_[0] == "comment" || words_.size() > 5) break;  // no line has more to say
    }
    return true;
  }

  void read_format() {
    if (words_.size() != 3 || words_[2] != "1.0") error("'{}', allowed: format NAME 1.0", shown(line_));
    if (words_[1] == "ascii") {
      header_.format = PlyHeader::Format::kAscii;
    } else if (words_[1] == "binary_little_endian") {
      header_.format = PlyHeader::Format::kLittleEndian;
    } else if (words_[1] == "binary_big_endian") {
      header_.format = PlyHeader::Format::kBigEndian;
    } else {
      error("format '{}', allowed: ascii, binary_little_endian, binary_big_endian", shown(words_[1]));
    }
  }

  void read_element() {
    PlyHeader::Element element;
    const std::string_view count = words_.size() == 3 ? words_[2] : "";
    const auto [end, problem] = std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (problem != std::errc() || end != count.data() + count.size())
      error("'{}', allowed: element NAME COUNT", shown(line_));
    element.name = words_[1];
    header_.elements.push_back(std::move(element));
  }

  Type type(std::string_view name) const {
    for (const TypeName& known : kTypes) {
      if (known.name == name) return known.type;
    }
    error("type '{}', allowed: char, uchar, short, ushort, int, uint, float, double, int8 … float64", shown(name));
  }

  void read_property() {
    if (header_.elements.empty()) error("a property before any element, allowed: after one");
    PlyHeader::Property property;
    property.is_list = words_.size() > 1 && words_[1] == "list";
    if (words_.size() != (property.is_list ? 5 : 3))
      error("'{}', allowed: property TYPE NAME, or property list TYPE TYPE NAME", shown(line_));
    property.name = words_.back();
    property.type = type(words_[words_.size() - 2]);
    if (property.is_list) {
      property.count_type = type(words_[2]);
      if (!is_integer(property.count_type)) error("a list's length is '{}', allowed: integer types", words_[2]);
    }
    auto& properties = header_.elements.back().properties;
    const auto same = [&](const PlyHeader::Property& other) { return other.name == property.name; };
    if (properties.size() == 256) error("an element of more than 256 properties, allowed: up to that");
    if (std::any_of(properties.begin(), properties.end(), same))
      error("a second property '{}' of '{}', allowed: one", shown(property.name), shown(header_.elements.back().name));
    properties.push_back(std::move(property));
  }

  std::string_view text_, line_;
  std::string file_;
  std::size_t at_ = 0, number_ = 0;
  std::vector<std::string_view> words_;
  PlyHeader header_;
};

}  // namespace

std::size_t size_of(Type type) {
  switch (type) {
    case Type::kInt8:
    case Type::kUInt8:
      return 1;
    case Type::kInt16:
    case Type::kUInt16:
      return 2;
    case Type::kInt32:
    case Type::kUInt32:
    case Type::kFloat32:
      return 4;
    case Type::kFloat64:
      return 8;
  }
  return 0;
}

bool is_integer(Type type) { return type != Type::kFloat32 && type != Type::kFloat64; }

PlyHeader parse_ply_header(std::string_view text, const std::string& file) { return HeaderReader(text, file).read(); }

}  // namespace halfslope
