#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "core/error.h"
#include "scenes/mesh_readers.h"
#include "scenes/ply_header.h"

namespace halfslope {
namespace {

using Property = PlyHeader::Property;
using Element = PlyHeader::Element;
using Type = PlyHeader::Type;

/// The values after the header, one after the other, whichever the format.
class Values {
 public:
  Values(std::string_view text, const std::string& file, const PlyHeader& header)
      : rest_(text.substr(header.bytes)),
        size_(text.size()),
        line_(header.lines + 1),
        file_(file),
        ascii_(header.format == PlyHeader::Format::kAscii),
        swap_(header.format == PlyHeader::Format::kBigEndian) {
    static_assert(std::endian::native == std::endian::little);
  }

  template <class... Args>
  [[noreturn]] void error(fmt::format_string<Args...> format, Args&&... args) const {
    const std::string place = ascii_ ? fmt::format(":{}", line_) : fmt::format(", byte {}", size_ - rest_.size());
    fail(ExitCode::kBadInput, "{}{}: {}", file_, place, fmt::format(format, std::forward<Args>(args)...));
  }

  /// Every type fits binary64.
  double next(Type type) {
    if (ascii_) return next_word(type);
    switch (type) {
      case Type::kInt8:
        return next_binary<std::int8_t>();
      case Type::kUInt8:
        return next_binary<std::uint8_t>();
      case Type::kInt16:
        return next_binary<std::int16_t>();
      case Type::kUInt16:
        return next_binary<std::uint16_t>();
      case Type::kInt32:
        return next_binary<std::int32_t>();
      case Type::kUInt32:
        return next_binary<std::uint32_t>();
      case Type::kFloat32:
        return static_cast<double>(next_binary<float>());
      case Type::kFloat64:
        return next_binary<double>();
    }
    return 0;
  }

  /// The length of a list, which what is left of the file can hold.
  std::size_t next_length(const Property& list) {
    const double length = next(list.count_type);
    if (length < 0) error("a list of {} values, allowed: 0 or more", length);
    check_room(length, least_bytes(list.type), "a list claims", "values");
    return static_cast<std::size_t>(length);
  }

  /// That what is left can hold what an element claims, before anything is allocated for it.
  void check_room(const Element& element) const {
    std::size_t least = 0;
    for (const Property& property : element.properties)
      least += least_bytes(property.is_list ? property.count_type : property.type);
    check_room(static_cast<double>(element.count), least, "an element claims", "items");
  }

  void finish() {
    if (ascii_) skip_blanks();
    if (!rest_.empty()) error("{} bytes after the last element, allowed: none", rest_.size());
  }

 private:
  std::size_t least_bytes(Type type) const { return ascii_ ? 2 : size_of(type); }  // a digit and a blank

  void check_room(double count, std::size_t bytes, const char* who, const char* what) const {
    const std::size_t left = rest_.size() + (ascii_ ? 1 : 0);  // the last line's end may be missing
    if (count * static_cast<double>(bytes) > static_cast<double>(left)) {
      error("{} {:.0f} {} of {} bytes or more, but the file has {} left", who, count, what, bytes, rest_.size());
    }
  }

  template <class T>
  T next_binary() {
    std::array<char, sizeof(T)> bytes;
    if (rest_.size() < sizeof(T)) error("the file ends inside a value of {} bytes", sizeof(T));
    std::memcpy(bytes.data(), rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    if (swap_) std::reverse(bytes.begin(), bytes.end());
    return std::bit_cast<T>(bytes);
  }

  void skip_blanks() {
    std::size_t count = 0;
    for (; count < rest_.size(); ++count) {
      const char c = rest_[count];
      if (c == '\n') {
        ++line_;
      } else if (c != ' ' && c != '\t' && c != '\r') {
        break;
      }
    }
    rest_.remove_prefix(count);
  }

  double next_word(Type type) {
    skip_blanks();
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n"));
    if (word.empty()) error("the file ends where a number should be");
    const std::size_t sign = word.size() > 1 && word[0] == '+' && word[1] != '-' ? 1 : 0;
    double value = 0;
    const auto [end, problem] = std::from_chars(word.data() + sign, word.data() + word.size(), value);
    if (problem != std::errc() || end != word.data() + word.size() ||
        (is_integer(type) && std::trunc(value) != value)) {
      error("'{}', allowed: {}", shown(word), is_integer(type) ? "an integer" : "a number");
    }
    rest_.remove_prefix(word.size());
    return value;
  }

  std::string_view rest_;
  std::size_t size_, line_;
  std::string file_;
  bool ascii_, swap_;
};

constexpr std::size_t kUnused = 8;

/// Where each property of a vertex goes: 0 to 2 the position, 3 to 5 the normal, 6 and 7 the uv.
struct VertexLayout {
  std::vector<std::size_t> places;
  bool has_normals = false, has_uvs = false;
};

std::optional<std::size_t> find(const Element& element, std::string_view name) {
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    if (element.properties[i].name == name) return i;
  }
  return std::nullopt;
}

VertexLayout vertex_layout(const Element& vertex, const std::string& file) {
  VertexLayout layout{std::vector(vertex.properties.size(), kUnused)};
  const auto place = [&](std::initializer_list<std::string_view> names, std::size_t first) {
    std::vector<std::size_t> found;
    for (const std::string_view name : names) {
      const auto i = find(vertex, name);
      if (!i) return false;
      if (vertex.properties[*i].is_list)
        fail(ExitCode::kBadInput, "{}: property '{}' of 'vertex' is a list, allowed: a number", file, name);
      found.push_back(*i);
    }
    for (const std::size_t i : found) layout.places[i] = first++;
    return true;
  };
  if (!place({"x", "y", "z"}, 0)) fail(ExitCode::kBadInput, "{}: 'vertex' has no x, y and z, allowed: all three", file);
  layout.has_normals = place({"nx", "ny", "nz"}, 3);
  layout.has_uvs = place({"u", "v"}, 6) || place({"texture_u", "texture_v"}, 6) || place({"s", "t"}, 6);
  return layout;
}

void skip(Values& values, const Property& property) {
  for (std::size_t n = property.is_list ? values.next_length(property) : 1; n > 0; --n) values.next(property.type);
}

void read_vertices(Values& values, const Element& vertex, const VertexLayout& layout, Mesh& mesh) {
  mesh.positions.reserve(vertex.count);
  if (layout.has_normals) mesh.normals.reserve(vertex.count);
  if (layout.has_uvs) mesh.uvs.reserve(vertex.count);
  for (std::uint64_t n = 0; n < vertex.count; ++n) {
    std::array<float, kUnused> read = {};
    for (std::size_t i = 0; i < vertex.properties.size(); ++i) {
      if (layout.places[i] == kUnused) {
        skip(values, vertex.properties[i]);
        continue;
      }
      const double value = values.next(vertex.properties[i].type);
      // A double beyond binary32 is undefined as a float to some tools: it counts as infinite here.
      const bool fits = std::abs(value) <= static_cast<double>(std::numeric_limits<float>::max());
      if (!fits)
        values.error("'{}' of vertex {} is {}, allowed: what binary32 holds", vertex.properties[i].name, n, value);
      read[layout.places[i]] = static_cast<float>(value);
    }
    mesh.positions.push_back({read[0], read[1], read[2]});
    if (layout.has_normals) mesh.normals.push_back({read[3], read[4], read[5]});
    if (layout.has_uvs) mesh.uvs.push_back({read[6], read[7]});
  }
}

void read_faces(Values& values, const Element& face, std::size_t list, std::uint64_t vertices, Mesh& mesh) {
  mesh.triangles.reserve(face.count);
  std::vector<std::uint32_t> polygon;
  for (std::uint64_t n = 0; n < face.count; ++n) {
    for (std::size_t i = 0; i < face.properties.size(); ++i) {
      if (i != list) {
        skip(values, face.properties[i]);
        continue;
      }
      polygon.resize(values.next_length(face.properties[i]));
      if (polygon.size() < 3) values.error("face {} has {} corners, allowed: 3 or more", n, polygon.size());
      for (std::uint32_t& index : polygon) {
        const double value = values.next(face.properties[i].type);
        if (!(value >= 0 && value < static_cast<double>(vertices)))
          values.error("index {} in face {}, allowed: 0 to {}", value, n, vertices - 1);
        index = static_cast<std::uint32_t>(value);
      }
      for (std::size_t k = 2; k < polygon.size(); ++k)
        mesh.triangles.push_back({polygon[0], polygon[k - 1], polygon[k]});
    }
  }
}

/// The list of a face's corners.
std::size_t corner_list(const Element& face, const std::string& file) {
  auto list = find(face, "vertex_indices");
  if (!list) list = find(face, "vertex_index");
  if (!list) fail(ExitCode::kBadInput, "{}: 'face' has no list vertex_indices or vertex_index, allowed: one", file);
  const Property& property = face.properties[*list];
  if (!property.is_list || !is_integer(property.type))
    fail(ExitCode::kBadInput, "{}: property '{}' of 'face' is no list of integers", file, property.name);
  return *list;
}

const Element& the_element(const PlyHeader& header, std::string_view name, const std::string& file) {
  const Element* found = nullptr;
  for (const Element& element : header.elements) {
    if (element.name != name) continue;
    if (found) fail(ExitCode::kBadInput, "{}: a second element '{}', allowed: one", file, name);
    found = &element;
  }
  if (!found) fail(ExitCode::kBadInput, "{}: no element '{}', allowed: one", file, name);
  return *found;
}

}  // namespace

Mesh parse_ply(std::string_view text, const std::string& file) {
  const PlyHeader header = parse_ply_header(text, file);
  const Element& vertex = the_element(header, "vertex", file);
  const Element& face = the_element(header, "face", file);
  const VertexLayout layout = vertex_layout(vertex, file);
  const std::size_t list = corner_list(face, file);
  if (vertex.count > std::numeric_limits<std::uint32_t>::max())
    fail(ExitCode::kBadInput, "{}: {} vertices, allowed: up to {}", file, vertex.count,
         std::numeric_limits<std::uint32_t>::max());
  Mesh mesh;
  Values values(text, file, header);
  for (const Element& element : header.elements) {
    values.check_room(element);
    if (&element == &vertex) {
      read_vertices(values, element, layout, mesh);
    } else if (&element == &face) {
      read_faces(values, element, list, vertex.count, mesh);
    } else if (!element.properties.empty()) {
      for (std::uint64_t n = 0; n < element.count; ++n) {
        for (const Property& property : element.properties) skip(values, property);
      }
    }
  }
  values.finish();
  return mesh;
}

}  // namespace halfslope
