#include "experiments/image_pattern.h"

#include <algorithm>
#include <array>
#include <charconv>

#include "core/error.h"
#include "experiments/joined.h"

namespace halfslope {
namespace {

const std::vector<std::string>& field_names() {
  static const std::vector<std::string> kNames = {"scene", "estimator", "sampler", "precision", "samples", "seed"};
  return kNames;
}

bool is_number(const std::string& field) { return field == "samples" || field == "seed"; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

std::optional<std::uint64_t> number_of(const std::string& digits) {
  std::uint64_t value = 0;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::string or_default(const std::map<std::string, std::string>& fields, const char* field, const char* otherwise) {
  const auto found = fields.find(field);
  return found == fields.end() ? otherwise : found->second;
}

std::string fields_text(const std::map<std::string, std::string>& fields) {
  std::vector<std::string> parts;
  for (const auto& [field, text] : fields) parts.push_back(field + " '" + text + "'");
  return joined(parts);
}

/// Names in a folder, sorted; folders alone where `folders`.
std::vector<std::string> names_in(const std::filesystem::path& folder, bool folders) {
  std::vector<std::string> names;
  try {
    for (const auto& entry : std::filesystem::directory_iterator(folder.empty() ? "." : folder)) {
      std::error_code ignored;
      if (folders ? entry.is_directory(ignored) : entry.is_regular_file(ignored))
        names.push_back(entry.path().filename().string());
    }
  } catch (const std::filesystem::filesystem_error& error) {
    fail(ExitCode::kIo, "{}: cannot be read: {}", folder.string(), error.code().message());
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

/// What a search has found, and how far the best of its ways went.
struct ImagePattern::Search {
  ImageMatches matches;
  std::filesystem::path deepest;
  std::size_t depth = 0;
};

ImagePattern::ImagePattern(const std::string& pattern, const char* flag) : pattern_(pattern) {
  if (pattern.empty()) fail(ExitCode::kUsage, "{}: is empty; such as 'out/{{sampler}}/{{samples}}_{{seed}}.exr'", flag);
  const std::filesystem::path path(pattern);
  root_ = path.root_path();
  for (const auto& part : path.relative_path()) {
    const std::string text = part.string();
    if (text.empty()) fail(ExitCode::kUsage, "{}: '{}' ends with a '/'; the pattern is of files", flag, pattern);
    Component component;
    for (std::size_t at = 0; at < text.size();) {
      if (text[at] != '{') {
        const std::size_t end = std::min(text.find('{', at), text.size());
        component.push_back({text.substr(at, end - at)});
        at = end;
        continue;
      }
      const std::size_t end = text.find('}', at);
      if (end == std::string::npos) {
        fail(ExitCode::kUsage, "{}: '{}' has a '{{' that no '}}' closes before the next '/'", flag, pattern);
      }
      const std::string field = text.substr(at + 1, end - at - 1);
      if (std::ranges::find(field_names(), field) == field_names().end()) {
        fail(ExitCode::kUsage, "{}: there is no field '{{{}}}'{}; allowed: {}", flag, field,
             did_you_mean(field, field_names()), joined(field_names()));
      }
      if (!component.empty() && component.back().field) {
        fail(ExitCode::kUsage, "{}: nothing parts '{{{}}}' from '{{{}}}'; put text or a '/' between them", flag,
             component.back().text, field);
      }
      component.push_back({field, true});
      at = end + 1;
    }
    components_.push_back(std::move(component));
  }
  if (!has("samples")) fail(ExitCode::kUsage, "{}: '{}' has no field {{samples}}, the N of an image", flag, pattern);
}

bool ImagePattern::has(const std::string& field) const {
  return std::ranges::any_of(components_, [&](const Component& component) {
    return std::ranges::any_of(component, [&](const Piece& p) { return p.field && p.text == field; });
  });
}

// Every way to part `text`, so that an ambiguous name is seen to be one.
void ImagePattern::match(const Component& component, std::size_t piece, std::string_view text, const Fields& fields,
                         std::vector<Fields>& found) {
  if (piece == component.size()) {
    if (text.empty()) found.push_back(fields);
    return;
  }
  const Piece& p = component[piece];
  if (!p.field) {
    if (text.starts_with(p.text)) match(component, piece + 1, text.substr(p.text.size()), fields, found);
    return;
  }
  const auto known = fields.find(p.text);
  for (std::size_t size = 1; size <= text.size(); ++size) {
    if (is_number(p.text) && !is_digit(text[size - 1])) break;
    // Digits end where they end: "64" is not "6", then "4".
    if (is_number(p.text) && size < text.size() && is_digit(text[size])) continue;
    const std::string value(text.substr(0, size));
    if (known != fields.end() && known->second != value) continue;
    Fields with = fields;
    with[p.text] = value;
    match(component, piece + 1, text.substr(size), with, found);
    if (found.size() > 1) return;
  }
}

void ImagePattern::descend(const std::filesystem::path& folder, std::size_t depth, const Fields& fields,
                           Search& search) const {
  if (depth > search.depth) {
    search.deepest = folder;
    search.depth = depth;
  }
  const Component& component = components_[depth];
  const bool last = depth + 1 == components_.size();
  if (component.size() == 1 && !component[0].field) {
    const std::filesystem::path path = folder / component[0].text;
    std::error_code ignored;
    if (!last && std::filesystem::is_directory(path, ignored)) descend(path, depth + 1, fields, search);
    if (last && std::filesystem::is_regular_file(path, ignored)) add(path, fields, search);
    return;
  }
  for (const std::string& name : names_in(folder, !last)) {
    std::vector<Fields> found;
    match(component, 0, name, fields, found);
    if (found.empty()) continue;
    if (found.size() > 1) {
      search.matches.problems.push_back(
          {(folder / name).string(),
           fmt::format("its name can be read as {}, and as {}; put other text or a '/' between the fields",
                       fields_text(found[0]), fields_text(found[1]))});
    } else if (last) {
      add(folder / name, found[0], search);
    } else {
      descend(folder / name, depth + 1, found[0], search);
    }
  }
}

void ImagePattern::add(const std::filesystem::path& path, const Fields& fields, Search& search) {
  ImageFile file;
  file.path = path;
  file.name = {or_default(fields, "scene", "image"), or_default(fields, "estimator", "image"),
               or_default(fields, "sampler", "image"), or_default(fields, "precision", ""), 0};
  const auto number = [&](const char* field) {
    const std::string& digits = fields.at(field);
    const auto value = number_of(digits);
    if (!value) {
      search.matches.problems.push_back(
          {path.string(), fmt::format("{} is {}; at most 2^64 - 1 is allowed", field, digits)});
    }
    return value;
  };
  const auto samples = number("samples");
  if (fields.contains("seed")) file.seed = number("seed");
  if (!samples || file.seed.has_value() != fields.contains("seed")) return;
  if (*samples == 0) {
    search.matches.problems.push_back({path.string(), "samples is 0; at least 1 is allowed"});
    return;
  }
  file.name.samples = *samples;
  search.matches.files.push_back(std::move(file));
}

ImageMatches ImagePattern::find() const {
  Search search;
  search.deepest = root_;
  descend(root_, 0, {}, search);
  if (search.matches.files.empty() && search.matches.problems.empty()) fail_without_match(search);
  return std::move(search.matches);
}

void ImagePattern::fail_without_match(const Search& search) const {
  constexpr std::size_t kMostNames = 3;
  const bool last = search.depth + 1 == components_.size();
  std::string wanted;
  for (const Piece& piece : components_[search.depth]) wanted += piece.field ? "{" + piece.text + "}" : piece.text;
  std::vector<std::string> names = names_in(search.deepest, !last), nearest;
  while (nearest.size() < kMostNames && !names.empty()) {
    const std::string near = nearest_name(wanted, names);
    const auto chosen = near.empty() ? names.begin() : std::ranges::find(names, near);
    nearest.push_back("'" + *chosen + "'");
    names.erase(chosen);
  }
  fail(ExitCode::kBadInput, "no file matches the pattern '{}': looked in '{}' for {} '{}'; it has {}", pattern_,
       search.deepest.empty() ? "." : search.deepest.string(), last ? "files like" : "a folder like", wanted,
       nearest.empty() ? std::string(last ? "no files" : "no folders")
                       : joined(nearest) + (names.empty() ? "" : fmt::format(" and {} more", names.size())));
}

std::string ImagePattern::path_of(const CellName& name, std::uint64_t seed) const {
  const Fields values = {{"scene", name.scene},
                         {"estimator", name.estimator},
                         {"sampler", name.sampler},
                         {"precision", name.precision},
                         {"samples", std::to_string(name.samples)},
                         {"seed", std::to_string(seed)}};
  std::filesystem::path path = root_;
  for (const Component& component : components_) {
    std::string text;
    for (const Piece& piece : component) text += piece.field ? values.at(piece.text) : piece.text;
    path /= text;
  }
  return path.string();
}

std::string with_scene(const std::string& path, const std::string& scene, const char* flag) {
  constexpr std::string_view kField = "{scene}";
  std::string text;
  std::size_t at = 0;
  for (std::size_t found = 0; (found = path.find('{', at)) != std::string::npos; at = found + kField.size()) {
    if (path.compare(found, kField.size(), kField) != 0)
      fail(ExitCode::kUsage, "{}: '{}' may have the field {{scene}} and no other", flag, path);
    text += path.substr(at, found - at) + scene;
  }
  return text + path.substr(at);
}

}  // namespace halfslope
