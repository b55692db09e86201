// Paths with fields: what a file's name says of its image.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "experiments/cell_name.h"

namespace halfslope {

/// A file that matches, by what its path says. Fields that the pattern lacks have default names: "image" for scene,
/// estimator and sampler; the precision is then empty.
struct ImageFile {
  std::filesystem::path path;
  CellName name;
  std::optional<std::uint64_t> seed;  ///< empty where the pattern has no {seed}
};

/// What is wrong with a file, a cell, or what is looked for: named, and the rest goes on.
struct ImageProblem {
  std::string what;  ///< a path, or a cell
  std::string text;
};

struct ImageMatches {
  std::vector<ImageFile> files;  ///< in the order of their paths
  std::vector<ImageProblem> problems;
};

/// "out/{estimator}/{sampler}/{samples}_{seed}.exr". Fields are {scene}, {estimator}, {sampler}, {precision}, {samples}
/// and {seed}. Each stands for at least one letter of one component of the path, {samples} and {seed} for digits; one
/// that comes twice stands for the same text. Everything else is literal.
class ImagePattern {
 public:
  /// Error(kUsage) that begins with `flag` for an unknown or unclosed field, two fields with nothing between them,
  /// which could be parted in many ways, or no {samples}.
  ImagePattern(const std::string& pattern, const char* flag);

  bool has(const std::string& field) const;

  /// Every file that matches, folders read in alphabetical order. A file whose name can be parted in several ways, or
  /// whose number is too large, is a problem. Error(kBadInput) that names the folder looked in and the files there that
  /// come nearest if none matches; Error(kIo) if a folder cannot be read.
  ImageMatches find() const;

  /// The path that a cell's image of that seed would have.
  std::string path_of(const CellName& name, std::uint64_t seed) const;

 private:
  /// A literal text, or a field.
  struct Piece {
    std::string text;
    bool field = false;
  };
  using Component = std::vector<Piece>;
  using Fields = std::map<std::string, std::string>;
  struct Search;

  static void match(const Component& component, std::size_t piece, std::string_view text, const Fields& fields,
                    std::vector<Fields>& found);
  void descend(const std::filesystem::path& folder, std::size_t depth, const Fields& fields, Search& search) const;
  static void add(const std::filesystem::path& path, const Fields& fields, Search& search);
  [[noreturn]] void fail_without_match(const Search& search) const;

  std::string pattern_;
  std::filesystem::path root_;  ///< "/" or empty
  std::vector<Component> components_;
};

/// "refs/{scene}.exr" for one scene; other text is itself. Error(kUsage) that begins with `flag` for other fields.
std::string with_scene(const std::string& path, const std::string& scene, const char* flag);

}  // namespace halfslope
