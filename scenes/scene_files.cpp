#include "scenes/scene_files.h"

#include <algorithm>

#include "core/atomic_file.h"
#include "scenes/upgrade.h"

namespace halfslope {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kDeepestInclude = 15;  // as Mitsuba
constexpr std::size_t kMostIncludes = 1000;
constexpr std::size_t kLongestName = 4095;  // as Linux

/// The first number of "0.6.0"; an error unless it is one that can be read.
int major_version(const Element& root, const std::string& version) {
  const bool known = version.size() >= 2 && version[0] >= '0' && version[0] <= '3' && version[1] == '.';
  if (!known) root.error("the scene's version is '{}', allowed: 0.x.x to 3.x.x, as Mitsuba's", version);
  return version[0] - '0';
}

/// One spelling for each file; what cannot be resolved stays as it is.
fs::path one_spelling(const fs::path& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? path : found;
}

}  // namespace

SceneFiles::SceneFiles(std::string text, const std::string& file, const SceneParameters& parameters)
    : substitution_(parameters),
      folders_({fs::path(file).parent_path()}),
      file_(std::make_unique<XmlFile>(std::move(text), file, budget_, ids_)) {
  if (root().tag() != "scene") root().unknown("root element", root().tag(), {"scene"});
  root().allow_attributes({"version"});
  version_ = root().attribute("version");
  Open open;
  prepare(*file_, open);
  substitution_.check_all_used(root());
  collect_ids(root());
  for (const Element& element : root().children()) {
    if (element.tag() != "alias") continue;
    element.allow_attributes({"id", "as"});
    const auto found = ids_.find(element.attribute("id"));
    if (found == ids_.end()) {
      std::vector<std::string> names;
      for (const auto& entry : ids_) names.push_back(entry.first);
      element.unknown("id", element.attribute("id"), names);
    }
    const auto [other, is_new] = ids_.emplace(element.attribute("as"), found->second);
    if (!is_new) element.error("the id '{}' is taken, by {}", other->first, other->second.place());
  }
}

void SceneFiles::prepare(XmlFile& file, Open& open) {
  const Element root(file, file.root());
  open.push_back(one_spelling(file.name()));
  const std::string version = root.find("version").value_or(version_);
  if (major_version(root, version) < 2) {
    upgrade_names(file.root());
    file.upgraded = true;
  }
  // Only a root has one, and an object of its own file is read as any other.
  if (root.tag() != "scene") root.node().remove_attribute("version");
  visit(file, root, open);
  open.pop_back();
}

void SceneFiles::visit(XmlFile& file, const Element& element, Open& open) {
  substitution_.apply(element);
  if (element.tag() == "include") return include(file, element, open);
  if (element.tag() == "path") add_folder(element);
  for (const pugi::xml_node child : element.node().children()) {
    element.refuse_text(child);
    visit(file, {file, child}, open);
  }
}

void SceneFiles::add_folder(const Element& element) {
  element.allow_attributes({"value"});
  const fs::path value = element.attribute("value");
  for (const fs::path& from : {fs::path(element.file().name()).parent_path(), folders_.front()}) {
    const fs::path folder = value.is_absolute() ? value : from / value;
    std::error_code error;
    if (!fs::is_directory(folder, error)) continue;
    folders_.push_back(folder);
    return;
  }
  element.error("there is no folder '{}', allowed: one that is there, as seen from this file or the scene's",
                value.string());
}

void SceneFiles::include(XmlFile& file, const Element& element, Open& open) {
  element.allow_attributes({"filename", "name"});
  if (!element.node().first_child().empty()) element.error("<include> has elements inside, allowed: none");
  const fs::path path = find(element, element.attribute("filename"));
  if (const auto cycle = std::find(open.begin(), open.end(), one_spelling(path)); cycle != open.end()) {
    std::string names;
    for (auto next = cycle; next != open.end(); ++next) names += next->filename().string() + " includes ";
    element.error("a cyclic <include>: {}{}", names, path.filename().string());
  }
  if (open.size() > kDeepestInclude) element.error("<include>s are nested more than {} deep", kDeepestInclude);
  if (included_.size() == kMostIncludes) element.error("more than {} <include>s", kMostIncludes);
  included_.push_back(path.string());
  // Before it is read: no file is, that the scene has no room for.
  std::error_code error;
  if (const auto bytes = fs::file_size(path, error); !error && bytes > budget_.bytes) {
    element.error("'{}' and the files before it are larger than {} MiB together", path.string(),
                  XmlBudget().bytes >> 20);
  }
  auto included = std::make_unique<XmlFile>(read_file(path), path.string(), budget_, ids_);
  XmlFile& inner = *included;
  file.include(element.node(), std::move(included));
  prepare(inner, open);
}

void SceneFiles::collect_ids(const Element& element) {
  if (const auto id = element.find("id"); id && element.tag() != "ref" && element.tag() != "alias") {
    const auto [other, is_new] = ids_.emplace(*id, element);
    if (!is_new) element.error("the id '{}' is taken, by {}", *id, other->second.place());
  }
  for (const Element& child : element.children()) collect_ids(child);
}

fs::path SceneFiles::find(const Element& element, const std::string& name) const {
  if (name.empty() || name.size() > kLongestName) {
    element.error("the name of a file has {} letters, allowed: 1 to {}", name.size(), kLongestName);
  }
  std::vector<fs::path> places = {name};
  if (!fs::path(name).is_absolute()) {
    places = {fs::path(element.file().name()).parent_path() / name};
    for (auto folder = folders_.rbegin(); folder != folders_.rend(); ++folder) places.push_back(*folder / name);
  }
  std::error_code error;
  for (const fs::path& place : places) {
    const fs::file_status status = fs::status(place, error);
    if (fs::is_regular_file(status)) return place;
    if (fs::exists(status)) {
      element.error("'{}' is {}, allowed: a file", place.string(),
                    fs::is_directory(status) ? "a folder" : "no regular file");
    }
  }
  std::string looked;
  for (const fs::path& place : places) {
    if (looked.find("'" + place.string() + "'") != std::string::npos) continue;
    looked += (looked.empty() ? "'" : ", '") + place.string() + "'";
  }
  element.error("there is no file {}", looked);
}

}  // namespace halfslope
