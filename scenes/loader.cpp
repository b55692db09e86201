#include "scenes/loader.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "core/atomic_file.h"
#include "scenes/readers.h"

namespace halfslope {

void Reading::ignore(const Properties& properties) {
  const Element& object = properties.element();
  for (const std::string& name : properties.unread()) {
    ++ignored[fmt::format("{} of {} '{}'", name, object.tag(), object.attribute("type"))];
  }
}

namespace {

/// What the file's path integrator is asked for; how any other renders is no part of what is integrated.
void read_integrator(const Element& element, Scene& scene, Reading& reading) {
  const std::string type = element.find("type").value_or("");
  const bool paths = type == "path" || type == "volpath" || type == "volpathmis";
  if (type == "direct") scene.max_depth = 2;
  for (const Element& child : element.children()) {
    if (child.tag() == "integrator") {  // inside one that adds to what it renders
      read_integrator(child, scene, reading);
      continue;
    }
    const std::string name = child.find("name").value_or(child.tag());
    if (!paths || (name != "max_depth" && name != "rr_depth")) {
      ++reading.ignored[fmt::format("{} of integrator '{}'", name, type)];
      continue;
    }
    child.allow_attributes({"name", "value"});
    const double depth = child.numbers("value", 1)[0];
    const bool whole = depth == std::trunc(depth) && depth >= 1 && depth < 1e9;
    if (!whole && !(name == "max_depth" && depth == -1)) {
      child.error("'{}' of integrator '{}' is {}, allowed: a whole number from 1{}", name, type, depth,
                  name == "max_depth" ? ", or -1 for no bound" : "");
    }
    (name == "rr_depth" ? scene.rr_depth : scene.max_depth) = static_cast<int>(depth);
  }
}

class SceneReader {
 public:
  SceneReader(const SceneFiles& files, const std::string& file) : reading_(files) {
    scene_.name = std::filesystem::path(file).stem().string();
  }

  void read(const Element& element) {
    const std::string tag = element.tag();
    if (tag == "shape") {
      ++shapes_;
      scene_.primitives.push_back(read_shape(element, shapes_, reading_));
    } else if (tag == "sensor") {
      if (has_sensor_) element.error("a second <sensor>, allowed: one");
      has_sensor_ = true;
      scene_.sensor = read_sensor(element, reading_);
    } else if (tag == "emitter") {
      add_light(element);
    } else if (tag == "bsdf") {
      read_bsdf(element, reading_);  // one that no shape refers to is checked too
    } else if (tag == "texture") {
      read_texture(element, reading_);
    } else if (tag == "integrator") {
      if (has_integrator_) element.error("a second <integrator>, allowed: one");
      has_integrator_ = true;
      read_integrator(element, scene_, reading_);
    } else if (tag != "default" && tag != "path" && tag != "alias") {
      element.unknown(
          "element in <scene>", tag,
          {"default", "include", "path", "alias", "integrator", "sensor", "texture", "bsdf", "emitter", "shape"});
    }
  }

  Scene finish(const Element& root) {
    if (!has_sensor_) root.error("the scene has no <sensor>, allowed: one");
    if (shapes_ == 0) root.error("the scene has no <shape>, allowed: one or more");
    return std::move(scene_);
  }

  const Reading& reading() const { return reading_; }

 private:
  void add_light(const Element& element) {
    auto light = read_emitter(element, reading_);
    if (auto* delta = std::get_if<DeltaLight>(&light)) {
      scene_.delta_lights.push_back(*delta);
      return;
    }
    if (scene_.environment) element.error("a second light from all around, allowed: one constant or envmap");
    scene_.environment = std::get<Environment>(std::move(light));
  }

  Scene scene_;
  Reading reading_;
  std::size_t shapes_ = 0;
  bool has_sensor_ = false, has_integrator_ = false;
};

/// Refuses a file that is larger than any scene's before it is read.
std::string read_scene_file(const std::filesystem::path& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (std::filesystem::exists(status) && !std::filesystem::is_directory(status) &&
      !std::filesystem::is_regular_file(status)) {
    fail(ExitCode::kBadInput, "{}: is no regular file", path.string());
  }
  const auto bytes = std::filesystem::file_size(path, error);
  if (!error && bytes > XmlBudget().bytes) {
    fail(ExitCode::kBadInput, "{}:1: the scene's files are larger than {} MiB together", path.string(),
         XmlBudget().bytes >> 20);
  }
  return read_file(path);
}

/// The places of errors that were told already: what two shapes refer to is wrong once.
void tell(SceneCheck& check, const Error& error) {
  if (std::find(check.problems.begin(), check.problems.end(), error.what()) == check.problems.end()) {
    check.problems.emplace_back(error.what());
  }
}

}  // namespace

Scene parse_scene(std::string_view text, const std::string& file, const SceneParameters& parameters) {
  const SceneFiles files(std::string(text), file, parameters);
  SceneReader reader(files, file);
  for (const Element& element : files.root().children()) reader.read(element);
  return reader.finish(files.root());
}

Scene load_scene(const std::filesystem::path& path, const SceneParameters& parameters) {
  return parse_scene(read_scene_file(path), path.string(), parameters);
}

namespace {

/// What a step throws for a wrong scene is told, and the next one goes on.
void attempt(SceneCheck& check, const std::function<void()>& step) {
  try {
    step();
  } catch (const Error& error) {
    if (error.code() != ExitCode::kBadInput) throw;
    tell(check, error);
  }
}

void read_all(SceneCheck& check, std::string text, const std::string& file, const SceneParameters& parameters) {
  const SceneFiles files(std::move(text), file, parameters);
  check.version = files.version();
  check.upgraded = files.upgraded();
  check.included = files.included();
  SceneReader reader(files, file);
  for (const Element& element : files.root().children()) attempt(check, [&] { reader.read(element); });
  attempt(check, [&] { check.scene = reader.finish(files.root()); });
  if (!check.problems.empty()) check.scene.reset();
  check.ignored = reader.reading().ignored;
  std::set<std::string> names;
  for (const auto& mesh : reader.reading().meshes) names.insert(mesh.first.string());
  for (const auto& bitmap : reader.reading().bitmaps) names.insert(bitmap.first.first.string());
  check.other_files.assign(names.begin(), names.end());
}

}  // namespace

SceneCheck check_scene(const std::filesystem::path& path, const SceneParameters& parameters) {
  SceneCheck check;
  attempt(check, [&] { read_all(check, read_scene_file(path), path.string(), parameters); });
  return check;
}

SceneCheck check_scene_text(std::string_view text, const std::string& file, const SceneParameters& parameters) {
  SceneCheck check;
  attempt(check, [&] { read_all(check, std::string(text), file, parameters); });
  return check;
}

}  // namespace halfslope
