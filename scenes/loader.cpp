#include "scenes/loader.h"

#include <algorithm>
#include <map>
#include <vector>

#include "core/atomic_file.h"
#include "scenes/readers.h"
#include "scenes/xml_reader.h"

namespace halfslope {
namespace {

/// Scenes are five levels deep; the bound keeps a hostile file from exhausting the stack.
constexpr int kMaxDepth = 64;

/// Replaces each $name in the file's attributes by what a <default> above it gives, in document order as Mitsuba does.
class Parameters {
 public:
  void substitute(const Element& element, int depth) {
    if (depth > kMaxDepth) element.error("elements are nested more than {} deep", kMaxDepth);
    for (pugi::xml_attribute attribute : element.node().attributes()) {
      const std::string_view text = attribute.value();
      if (text.find('$') != std::string_view::npos) attribute.set_value(expand(element, text).c_str());
    }
    if (element.tag() == "default") {
      element.allow_attributes({"name", "value"});
      const std::string name = element.attribute("name");
      if (name.empty()) element.error("the name of <default> is empty");
      values_.emplace(name, element.attribute("value"));
    }
    for (const Element& child : element.children()) substitute(child, depth + 1);
  }

 private:
  std::string expand(const Element& element, std::string_view text) const {
    std::string expanded;
    for (std::size_t at = 0; at < text.size();) {
      if (text[at] != '$') {
        expanded += text[at++];
        continue;
      }
      // The longest name that fits: $radius_2 is not $radius.
      const std::pair<const std::string, std::string>* best = nullptr;
      for (const auto& entry : values_) {
        const bool fits = text.substr(at + 1).starts_with(entry.first);
        if (fits && (!best || entry.first.size() > best->first.size())) best = &entry;
      }
      if (!best) {
        std::vector<std::string> names;
        for (const auto& entry : values_) names.push_back("$" + entry.first);
        element.unknown("parameter", text.substr(at), names);
      }
      expanded += best->second;
      at += 1 + best->first.size();
    }
    return expanded;
  }

  std::map<std::string, std::string> values_;
};

/// The bsdfs that have an id: at the top, or inside a shape.
std::map<std::string, Bsdf> named_bsdfs(const std::vector<Element>& elements) {
  std::map<std::string, Bsdf> bsdfs;
  const auto add = [&](const Element& element) {
    if (const auto id = element.find("id")) bsdfs.emplace(*id, read_bsdf(element));
  };
  for (const Element& element : elements) {
    if (element.tag() == "bsdf") add(element);
    if (element.tag() != "shape") continue;
    for (const Element& child : element.children()) {
      if (child.tag() == "bsdf") add(child);
    }
  }
  return bsdfs;
}

void check_unique_ids(const Element& element, std::map<std::string, Element>& seen) {
  if (const auto id = element.find("id"); id && element.tag() != "ref") {
    const auto [other, is_new] = seen.emplace(*id, element);
    if (!is_new) element.error("the id '{}' is taken, by {}", *id, other->second.place());
  }
  for (const Element& child : element.children()) check_unique_ids(child, seen);
}

void check_root(const Element& root) {
  if (root.tag() != "scene") root.unknown("root element", root.tag(), {"scene"});
  root.allow_attributes({"version"});
  const std::string version = root.attribute("version");
  if (!version.starts_with("3.")) root.error("the scene's version is '{}', allowed: 3.x.x, Mitsuba 3", version);
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file) {
  const XmlFile xml(text, file);
  const Element root(xml, xml.root());
  check_root(root);
  Parameters().substitute(root, 1);
  std::map<std::string, Element> ids;
  check_unique_ids(root, ids);

  Scene scene;
  scene.name = std::filesystem::path(file).stem().string();
  const std::vector<Element> elements = root.children();
  const std::map<std::string, Bsdf> bsdfs = named_bsdfs(elements);
  bool has_sensor = false;
  for (const Element& element : elements) {
    const std::string tag = element.tag();
    if (tag == "shape") {
      scene.primitives.push_back(read_shape(element, bsdfs, scene.primitives.size() + 1));
    } else if (tag == "sensor") {
      if (has_sensor) element.error("a second <sensor>, allowed: one");
      scene.sensor = read_sensor(element);
      has_sensor = true;
    } else if (tag == "bsdf") {
      read_bsdf(element);  // one that no shape refers to is checked too
    } else if (tag != "default" && tag != "integrator") {
      // An integrator is how Mitsuba renders the scene, no part of what is integrated.
      element.unknown("element in <scene>", tag, {"default", "integrator", "sensor", "bsdf", "shape"});
    }
  }
  if (!has_sensor) root.error("the scene has no <sensor>, allowed: one");
  if (scene.primitives.empty()) root.error("the scene has no <shape>, allowed: one or more");
  return scene;
}

Scene load_scene(const std::filesystem::path& path) { return parse_scene(read_file(path), path.string()); }

}  // namespace halfslope
