// What a figure's SVG says, read back.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <pugixml.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace halfslope {

inline std::vector<std::string> texts(const pugi::xml_document& document) {
  std::vector<std::string> found;
  for (const auto& node : document.select_nodes("//text")) found.push_back(node.node().child_value());
  return found;
}

struct Place {
  double x, y;
};

inline std::vector<Place> points_of(const pugi::xml_node& node) {
  std::vector<Place> points;
  std::istringstream text(node.attribute("points").value());
  char comma;
  for (Place p{}; text >> p.x >> comma >> p.y;) points.push_back(p);
  return points;
}

/// The value that an axis has at a place, through two of its labels.
struct LinearMap {
  double a, b;
  LinearMap(double place0, double value0, double place1, double value1)
      : a(value0 - place0 * (value1 - value0) / (place1 - place0)), b((value1 - value0) / (place1 - place0)) {}
  double value(double place) const { return a + b * place; }
};
struct LogMap {
  LinearMap log;
  LogMap(double place0, double value0, double place1, double value1)
      : log(place0, std::log(value0), place1, std::log(value1)) {}
  double value(double place) const { return std::exp(log.value(place)); }
};

/// Where a label stands first: x of its middle, or y of its middle line (the baseline is 0.36 of the size below).
inline double place_of(const pugi::xml_document& document, const std::string& label, bool is_x) {
  const char* anchor = is_x ? "middle" : "end";
  const auto node =
      document.select_node(("//text[text()='" + label + "' and @text-anchor='" + anchor + "']").c_str()).node();
  EXPECT_TRUE(node) << label;
  return is_x ? node.attribute("x").as_double()
              : node.attribute("y").as_double() - 0.36 * node.attribute("font-size").as_double();
}

}  // namespace halfslope
