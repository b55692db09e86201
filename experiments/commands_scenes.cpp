// scenes check: what scene files hold, and what is wrong with them.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "estimators/path_transport.h"
#include "experiments/commands.h"
#include "experiments/joined.h"
#include "experiments/message.h"
#include "experiments/scene_summary.h"
#include "experiments/text_table.h"
#include "scenes/catalogue.h"
#include "scenes/loader.h"

namespace halfslope {
namespace {

using Json = nlohmann::ordered_json;

// Of how many lights, and of how many files, a person is told.
constexpr std::size_t kTold = 16;

std::string spelled(const Rgb& colour) {
  if (colour[0] == colour[1] && colour[1] == colour[2]) return fmt::format("{:.6g}", colour[0]);
  return fmt::format("{:.6g} {:.6g} {:.6g}", colour[0], colour[1], colour[2]);
}

std::string counted(const std::map<std::string, std::size_t>& counts) {
  std::vector<std::string> parts;
  for (const auto& [name, count] : counts) parts.push_back(fmt::format("{} {}", count, name));
  return parts.empty() ? "none" : joined(parts);
}

std::string bounded(std::vector<std::string> names) {
  const std::size_t more = names.size() - std::min(names.size(), kTold);
  names.resize(names.size() - more);
  return joined(names) + (more > 0 ? fmt::format(" and {} more", more) : "");
}

void print_text(const std::string& name, const SceneCheck& check) {
  fmt::print("{}\n", name);
  std::vector<std::vector<std::string>> rows;
  const auto row = [&](const std::string& label, const std::string& value) { rows.push_back({label, value}); };
  row("version", check.version + (check.upgraded ? ", read in the spelling of Mitsuba 3" : ""));
  if (!check.included.empty()) row("includes", bounded(check.included));
  if (!check.other_files.empty()) row("files", bounded(check.other_files));
  const SceneSummary summary = summarise(*check.scene);
  row("shapes", counted(summary.shapes));
  if (summary.triangles > 0) {
    row("triangles",
        fmt::format("{}{}", summary.triangles,
                    summary.degenerate == 0 ? "" : fmt::format(", and {} without area, left out", summary.degenerate)));
  }
  row("materials", counted(summary.materials));
  row("textures", counted(summary.textures));
  for (std::size_t i = 0; i < std::min(summary.lights.size(), kTold); ++i) {
    const LightSummary& light = summary.lights[i];
    row("light", fmt::format("{}{} {} {}", light.kind, light.id.empty() ? "" : " '" + light.id + "',",
                             spelled(light.power), light.unit));
  }
  if (summary.lights.size() > kTold) row("light", fmt::format("{} more", summary.lights.size() - kTold));
  row("sensor", summary.sensor);
  row("filter", summary.filter);
  const auto depth = [](const std::optional<int>& given) { return given ? fmt::format("{}", *given) : "not given"; };
  const bool unbounded = check.scene->max_depth == -1;
  row("max_depth", unbounded ? fmt::format("no bound: paths go to {}", kMostDepth) : depth(check.scene->max_depth));
  row("rr_depth", depth(check.scene->rr_depth));
  for (const auto& [what, count] : check.ignored)
    row("not read", what + (count > 1 ? fmt::format(", {} times", count) : ""));
  for (const std::string& line : summary.skips) row("work", line);
  fmt::print("{}", align(rows, 2));
}

Json json_of(const std::string& name, const SceneCheck& check) {
  Json json = {{"file", name},
               {"version", check.version},
               {"upgraded", check.upgraded},
               {"includes", check.included},
               {"files", check.other_files},
               {"ignored", check.ignored},
               {"problems", check.problems}};
  if (!check.scene) return json;
  const Scene& scene = *check.scene;
  const SceneSummary summary = summarise(scene);
  const auto depth = [](const std::optional<int>& given) { return given ? Json(*given) : Json(nullptr); };
  json["shapes"] = summary.shapes;
  json["triangles"] = summary.triangles;
  json["degenerate"] = summary.degenerate;
  json["pieces"] = summary.pieces;
  json["materials"] = summary.materials;
  json["textures"] = summary.textures;
  json["lights"] = Json::array();
  for (const LightSummary& light : summary.lights) {
    json["lights"].push_back({{"kind", light.kind},
                              {"id", light.id},
                              {"power", {light.power[0], light.power[1], light.power[2]}},
                              {"unit", light.unit}});
  }
  json["sensor"] = summary.sensor;
  json["filter"] = summary.filter;
  json["width"] = scene.sensor.width;
  json["height"] = scene.sensor.height;
  json["max_depth"] = depth(scene.max_depth);
  json["rr_depth"] = depth(scene.rr_depth);
  json["work"] = summary.skips;
  return json;
}

SceneCheck check_of(const std::string& name) {
  if (const auto shipped = shipped_scene_text(name)) return check_scene_text(*shipped, name + ".xml");
  const SceneName scene = parse_scene_name(name);
  return check_scene(scene.file, scene.parameters);
}

}  // namespace

int scenes_check_command(const ScenesCheckArguments& a) {
  ExitCode code = ExitCode::kDone;
  Json all = Json::array();
  for (const std::string& name : a.files) {
    SceneCheck check;
    try {
      check = check_of(name);
    } catch (const Error& error) {
      if (code == ExitCode::kDone) code = error.code();
      check.problems.emplace_back(error.what());
    }
    if (!check.scene && code == ExitCode::kDone) code = ExitCode::kBadInput;
    for (const std::string& problem : check.problems) message("halfslope: {}\n", problem);
    if (a.json) {
      all.push_back(json_of(name, check));
    } else if (check.scene) {
      print_text(name, check);
    }
  }
  if (a.json) fmt::print("{}\n", all.dump(2, ' ', false, Json::error_handler_t::replace));
  return static_cast<int>(code);
}

}  // namespace halfslope
