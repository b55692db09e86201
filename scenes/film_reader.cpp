#include <algorithm>
#include <string>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

/// Mitsuba's filters with its defaults: box of radius ½, tent of radius 1, gaussian of stddev ½ cut off at 4 stddev.
ReconstructionFilter read_filter(const Element& element) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"box", "tent", "gaussian"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("rfilter", type, types);
  using Kind = ReconstructionFilter::Kind;
  Properties properties(element, {});
  const bool gaussian = type == "gaussian";
  const auto size = properties.number(gaussian ? "stddev" : "radius");
  properties.finish();
  ReconstructionFilter filter;
  filter.kind = gaussian ? Kind::kGaussian : type == "box" ? Kind::kBox : Kind::kTent;
  if (size && !(*size > 0 && *size <= 100)) {
    properties.reject(gaussian ? "stddev" : "radius", fmt::format("{}", *size), "above 0, up to 100 pixels");
  }
  if (gaussian) {
    filter.stddev = size.value_or(0.5);
    filter.radius = 4 * filter.stddev;
  } else {
    filter.radius = size.value_or(type == "box" ? 0.5 : 1);
  }
  return filter;
}

}  // namespace

/// How Mitsuba stores the image does not touch what is integrated: those names pass unread.
Film read_film(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  if (type != "hdrfilm") element.unknown("film", type, {"hdrfilm"});
  Properties properties(element, {"rfilter"});
  Film film;
  const auto size = [&](const std::string& name, int absent) {
    const int value = properties.integer(name).value_or(absent);
    if (value < 1 || value > 65536) properties.reject(name, fmt::format("{}", value), "1 to 65536");
    return value;
  };
  film.width = size("width", film.width);
  film.height = size("height", film.height);
  properties.know({"file_format", "pixel_format", "component_format", "banner", "sample_border", "compensate"});
  properties.finish();
  reading.ignore(properties);
  if (const auto filter = properties.object("rfilter")) film.filter = read_filter(*filter);
  return film;
}

}  // namespace halfslope
