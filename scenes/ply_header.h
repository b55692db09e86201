// The header of a PLY file.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace halfslope {

struct PlyHeader {
  enum class Format : std::uint8_t { kAscii, kLittleEndian, kBigEndian } format = Format::kAscii;
  enum class Type : std::uint8_t { kInt8, kUInt8, kInt16, kUInt16, kInt32, kUInt32, kFloat32, kFloat64 };
  struct Property {
    std::string name;
    Type type = Type::kFloat32;
    bool is_list = false;
    Type count_type = Type::kUInt8;  ///< of a list's length
  };
  struct Element {
    std::string name;
    std::uint64_t count = 0;  ///< claimed: nothing may be allocated for it
    std::vector<Property> properties;
  };
  std::vector<Element> elements;
  std::size_t bytes = 0, lines = 0;  ///< of the header: where the data begin
};

/// Bytes of a value in a binary file.
std::size_t size_of(PlyHeader::Type type);
bool is_integer(PlyHeader::Type type);

/// Throws Error(kBadInput) with file:line.
PlyHeader parse_ply_header(std::string_view text, const std::string& file);

}  // namespace halfslope
