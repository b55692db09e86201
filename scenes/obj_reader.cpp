#include <cmath>
#include <cstdint>
#include <istream>
#include <streambuf>
#include <unordered_map>

#include "core/error.h"
#include "scenes/mesh_readers.h"

#define TINYOBJLOADER_IMPLEMENTATION
#include <tiny_obj_loader.h>

namespace halfslope {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// The words of one line.
class Words {
 public:
  explicit Words(std::string_view line) : rest_(line) {}
  /// Empty at the end of the line.
  std::string_view next() {
    std::size_t begin = 0;
    while (begin < rest_.size() && is_space(rest_[begin])) ++begin;
    std::size_t end = begin;
    while (end < rest_.size() && !is_space(rest_[end])) ++end;
    const std::string_view word = rest_.substr(begin, end - begin);
    rest_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view rest_;
};

std::size_t skip_digits(std::string_view& text) {
  std::size_t count = 0;
  while (count < text.size() && is_digit(text[count])) ++count;
  text.remove_prefix(count);
  return count;
}

void skip_sign(std::string_view& text) {
  if (!text.empty() && (text[0] == '+' || text[0] == '-')) text.remove_prefix(1);
}

/// Whether the library reads all of a word as a number: what it does not understand it takes for 0, without a word, and
/// an exponent beyond int is undefined.
bool is_number(std::string_view word) {
  skip_sign(word);
  std::size_t digits = skip_digits(word);
  if (!word.empty() && word[0] == '.') {
    word.remove_prefix(1);
    digits += skip_digits(word);
  }
  if (digits == 0) return false;
  if (!word.empty() && (word[0] == 'e' || word[0] == 'E')) {
    word.remove_prefix(1);
    skip_sign(word);
    const std::size_t exponent = skip_digits(word);
    if (exponent == 0 || exponent > 6) return false;
  }
  return word.empty();
}

/// Whether a word is i, i/j, i//k or i/j/k, each an index other than 0 that fits an int.
bool is_corner(std::string_view word) {
  const auto index = [&] {
    skip_sign(word);
    const std::string_view digits = word;
    const std::size_t count = skip_digits(word);
    return count > 0 && count < 10 && digits.substr(0, count).find_first_not_of('0') != std::string_view::npos;
  };
  if (!index()) return false;
  if (word.empty()) return true;
  word.remove_prefix(word[0] == '/' ? 1 : 0);
  if (word.starts_with('/')) {
    word.remove_prefix(1);
    return index() && word.empty();
  }
  if (!index()) return false;
  if (word.empty()) return true;
  if (word[0] != '/') return false;
  word.remove_prefix(1);
  return index() && word.empty();
}

/// Gives the library the lines that make a mesh, one by one, each looked at first, and knows which one it is at.
class Lines : public std::streambuf {
 public:
  Lines(std::string_view text, const std::string& file) : rest_(text), file_(file) {}

  template <class... Args>
  [[noreturn]] void error(fmt::format_string<Args...> format, Args&&... args) const {
    fail(ExitCode::kBadInput, "{}:{}: {}", file_, line_, fmt::format(format, std::forward<Args>(args)...));
  }

 protected:
  int_type underflow() override {
    if (in_line_) {
      // Every line ends alike for the library, which would look beyond a lone carriage return into the next one.
      in_line_ = false;
      return give(newline_, 1);
    }
    while (!rest_.empty()) {
      ++line_;
      const std::size_t end = rest_.find_first_of("\r\n");
      const std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(line.size());
      rest_.remove_prefix(rest_.starts_with("\r\n") ? 2 : rest_.empty() ? 0 : 1);
      if (!is_wanted(line)) continue;
      in_line_ = true;
      // A get area is not const, though nothing writes to it.
      return give(const_cast<char*>(line.data()), line.size());
    }
    return traits_type::eof();
  }

 private:
  bool is_wanted(std::string_view line) const {
    Words words(line);
    const std::string_view keyword = words.next();
    const std::size_t numbers = keyword == "v" || keyword == "vn" ? 3 : keyword == "vt" ? 2 : 0;
    if (numbers == 0 && keyword != "f") return false;
    std::size_t count = 0;
    for (std::string_view word = words.next(); !word.empty(); word = words.next(), ++count) {
      if (numbers == 0 ? is_corner(word) : is_number(word)) continue;
      error("'{}' in '{}', allowed: {}", shown(word), keyword,
            numbers == 0 ? "indices as i, i/j, i//k or i/j/k, from 1 up or from -1 down" : "numbers");
    }
    const std::size_t least = numbers == 0 ? 3 : numbers;
    if (count < least)
      error("{} {} in '{}', allowed: {} or more", count, numbers == 0 ? "corners" : "numbers", keyword, least);
    return true;
  }

  int_type give(char* begin, std::size_t size) {
    setg(begin, begin, begin + size);
    return traits_type::to_int_type(*begin);
  }

  std::string_view rest_;
  std::string file_;
  std::size_t line_ = 0;
  bool in_line_ = false;
  char newline_[1] = {'\n'};
};

/// What a corner of a face asks for, counted from 0; −1 for nothing.
struct Corner {
  std::int32_t position, uv, normal;
  bool operator==(const Corner&) const = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t hash = static_cast<std::uint32_t>(corner.position);
    for (const std::int32_t next : {corner.uv, corner.normal}) {
      hash = (hash ^ hash >> 29) * 0x9e3779b97f4a7c15 + static_cast<std::uint32_t>(next);
    }
    return (hash ^ hash >> 32) * 0xd6e8feb86659fd93;
  }
};

/// What the library reports, made into a mesh.
class Builder {
 public:
  explicit Builder(const Lines& lines) : lines_(lines) {}

  void add_position(float x, float y, float z) { positions_.push_back(finite<3>("v", {x, y, z})); }
  void add_normal(float x, float y, float z) { normals_.push_back(finite<3>("vn", {x, y, z})); }
  void add_uv(float u, float v) { uvs_.push_back(finite<2>("vt", {u, 1 - v})); }

  void add_face(const tinyobj::index_t* corners, int count) {
    polygon_.clear();
    for (int i = 0; i < count; ++i) {
      const Corner corner = {find("position", corners[i].vertex_index, positions_.size()),
                             find("texture coordinate", corners[i].texcoord_index, uvs_.size()),
                             find("normal", corners[i].normal_index, normals_.size())};
      polygon_.push_back(vertex(corner));
    }
    for (std::size_t i = 2; i < polygon_.size(); ++i)
      mesh_.triangles.push_back({polygon_[0], polygon_[i - 1], polygon_[i]});
  }

  Mesh finish() {
    // Only what a face asks for is there to have.
    if (!has_uvs_) mesh_.uvs.clear();
    if (!has_normals_) mesh_.normals.clear();
    return std::move(mesh_);
  }

 private:
  template <std::size_t n>
  std::array<float, n> finite(const char* keyword, std::array<float, n> values) const {
    for (const float value : values) {
      if (!std::isfinite(value)) lines_.error("a number in '{}' leaves binary32, allowed: up to 3.4e38", keyword);
    }
    return values;
  }

  std::int32_t find(const char* what, int index, std::size_t count) const {
    if (index == 0) return -1;
    const std::int64_t found = index > 0 ? index - std::int64_t{1} : static_cast<std::int64_t>(count) + index;
    if (found >= 0 && found < static_cast<std::int64_t>(count)) return static_cast<std::int32_t>(found);
    if (count == 0) lines_.error("{} {} in 'f', but none comes before it", what, index);
    lines_.error("{} {} in 'f', allowed: 1 to {} or -1 to -{}, those before it", what, index, count, count);
  }

  std::uint32_t vertex(const Corner& corner) {
    const auto [entry, is_new] = vertices_.try_emplace(corner, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (is_new) {
      has_uvs_ |= corner.uv >= 0;
      has_normals_ |= corner.normal >= 0;
      mesh_.positions.push_back(positions_[static_cast<std::size_t>(corner.position)]);
      mesh_.uvs.push_back(corner.uv < 0 ? std::array<float, 2>{} : uvs_[static_cast<std::size_t>(corner.uv)]);
      mesh_.normals.push_back(corner.normal < 0 ? Mesh::Point{} : normals_[static_cast<std::size_t>(corner.normal)]);
    }
    return entry->second;
  }

  const Lines& lines_;
  std::vector<Mesh::Point> positions_, normals_;
  std::vector<std::array<float, 2>> uvs_;
  std::unordered_map<Corner, std::uint32_t, CornerHash> vertices_;
  std::vector<std::uint32_t> polygon_;
  Mesh mesh_;
  bool has_uvs_ = false, has_normals_ = false;
};

}  // namespace

Mesh parse_obj(std::string_view text, const std::string& file) {
  Lines lines(text, file);
  Builder builder(lines);
  tinyobj::callback_t callback;
  callback.vertex_cb = [](void* to, float x, float y, float z, float) {
    static_cast<Builder*>(to)->add_position(x, y, z);
  };
  callback.normal_cb = [](void* to, float x, float y, float z) { static_cast<Builder*>(to)->add_normal(x, y, z); };
  callback.texcoord_cb = [](void* to, float u, float v, float) { static_cast<Builder*>(to)->add_uv(u, v); };
  callback.index_cb = [](void* to, tinyobj::index_t* corners, int count) {
    static_cast<Builder*>(to)->add_face(corners, count);
  };
  std::istream stream(&lines);
  stream.exceptions(std::ios::badbit);  // lets what the line reader throws through
  tinyobj::LoadObjWithCallback(stream, callback, &builder);
  return builder.finish();
}

}  // namespace halfslope
