// Scenes that are wrong in one place, and what is said of them.
#pragma once

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "core/error.h"
#include "scenes/loader.h"

namespace halfslope {

struct Wrong {
  const char* name;
  std::string text;
  const char* message;
};

inline void PrintTo(const Wrong& wrong, std::ostream* out) { *out << wrong.name; }

inline std::string failure(const std::string& text) {
  try {
    parse_scene(text, "wrong.xml");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "no error";
}

/// Wrong things inside the scene stand on line 3.
inline std::string scene(const std::string& line_3) {
  return "<scene version='3.0.0'>\n<sensor type='radiancemeter'/>\n" + line_3 + "\n<shape type='sphere'/>\n</scene>";
}
inline std::string with_sensor(const std::string& line_3) {
  return "<scene version='3.0.0'>\n<shape type='sphere'/>\n" + line_3 + "\n</scene>";
}
inline std::string sphere(const std::string& inside) { return scene("<shape type='sphere'>" + inside + "</shape>"); }
inline std::string rectangle(const std::string& steps) {
  return scene("<shape type='rectangle'><transform name='to_world'>" + steps + "</transform></shape>");
}
inline std::string bsdf(const std::string& type, const std::string& inside) {
  return scene("<bsdf type='" + type + "'>" + inside + "</bsdf>");
}
inline std::string ggx(const std::string& inside) {
  return bsdf("roughconductor", "<string name='distribution' value='ggx'/>" + inside);
}
inline std::string meter(const std::string& type, const std::string& inside) {
  return with_sensor("<sensor type='" + type + "'>" + inside + "</sensor>");
}
inline std::string camera(const std::string& inside) {
  return meter("perspective", "<float name='fov' value='40'/>" + inside);
}
inline std::string emitter(const std::string& inside) {
  return sphere("<emitter type='area'>" + inside + "</emitter>");
}

inline std::string name_of(const testing::TestParamInfo<Wrong>& info) { return info.param.name; }

}  // namespace halfslope
