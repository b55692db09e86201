#include <algorithm>
#include <string>
#include <vector>

#include "scenes/readers.h"

namespace halfslope {
namespace {

void check_albedo(const Properties& properties, const std::string& name, const Rgb& colour) {
  if (!((colour >= 0).all() && (colour <= 1).all())) {
    properties.reject(name, fmt::format("({}, {}, {})", colour[0], colour[1], colour[2]),
                      "from 0 to 1 in each channel");
  }
}

/// `alpha`, or `alpha_u` and `alpha_v` where they agree; Mitsuba's default is 0.1.
double read_alpha(Properties& properties) {
  const auto alpha = properties.number("alpha"), u = properties.number("alpha_u"), v = properties.number("alpha_v");
  if (u.has_value() != v.has_value()) properties.reject(u ? "alpha_u" : "alpha_v", "alone", "both alpha_u and alpha_v");
  if (alpha && u) properties.reject("alpha", "given beside alpha_u and alpha_v", "one or the other");
  if (u && *u != *v)
    properties.reject("alpha_v", fmt::format("{}, alpha_u {}", *v, *u), "the same roughness both ways");
  const double roughness = alpha ? *alpha : u.value_or(0.1);
  if (!(roughness > 0 && roughness <= 1)) {
    properties.reject(alpha ? "alpha" : "alpha_u", fmt::format("{}", roughness), "above 0, up to 1");
  }
  return roughness;
}

/// Material "none" (Mitsuba's default) is a perfect mirror's F = 1; otherwise eta and k.
void read_index(Properties& properties, Bsdf& bsdf) {
  const auto material = properties.string("material");
  const auto eta = properties.colour("eta"), k = properties.colour("k");
  if (material && *material != "none") {
    properties.reject("material", fmt::format("'{}'", *material), "none, or eta and k instead of a material");
  }
  if (material && (eta || k)) properties.reject("material", "given beside eta or k", "one or the other");
  bsdf.unit_fresnel = !eta && !k;
  if (bsdf.unit_fresnel) return;
  if (!eta || !k) properties.reject(eta ? "eta" : "k", "alone", "both eta and k");
  bsdf.eta = *eta;
  bsdf.k = *k;
  if (!((*eta >= 0).all() && (*k >= 0).all() && (*eta + *k > 0).all())) {
    properties.reject("eta", "negative, or zero where k is zero", "eta >= 0 and k >= 0, not both 0");
  }
}

Bsdf read_rough_conductor(Properties& properties) {
  Bsdf bsdf;
  bsdf.kind = BsdfKind::kRoughConductor;
  const auto distribution = properties.string("distribution");
  const auto sample_visible = properties.boolean("sample_visible");
  const auto reflectance = properties.colour("specular_reflectance");
  properties.know({"material", "eta", "k", "alpha", "alpha_u", "alpha_v"});
  properties.finish();
  if (!distribution) {
    properties.reject("distribution", "absent (beckmann, Mitsuba's default)",
                      "ggx: write <string name=\"distribution\" value=\"ggx\"/>");
  }
  if (*distribution != "ggx") properties.reject("distribution", fmt::format("'{}'", *distribution), "ggx");
  if (sample_visible == false) properties.reject("sample_visible", "false", "true");
  bsdf.reflectance = reflectance.value_or(Rgb::Ones());
  check_albedo(properties, "specular_reflectance", bsdf.reflectance);
  bsdf.alpha = read_alpha(properties);
  read_index(properties, bsdf);
  return bsdf;
}

/// A reflectance under Mitsuba 3's spelling or Mitsuba 0.6's.
struct NamedColour {
  std::string name;  ///< the one that is given
  Rgb colour;
};

NamedColour read_either(Properties& properties, const std::string& snake, const std::string& camel, double absent) {
  const auto by_snake = properties.colour(snake), by_camel = properties.colour(camel);
  if (by_snake && by_camel) properties.reject(camel, fmt::format("given beside {}", snake), "one or the other");
  if (by_camel) return {camel, *by_camel};
  return {snake, by_snake.value_or(Rgb::Constant(absent))};
}

/// Mitsuba 0.6's phong, with its defaults. It would scale a sum of reflectances above 1 down without a word.
Bsdf read_phong(Properties& properties) {
  Bsdf bsdf;
  bsdf.kind = BsdfKind::kPhong;
  const auto diffuse = read_either(properties, "diffuse_reflectance", "diffuseReflectance", 0.5);
  const auto specular = read_either(properties, "specular_reflectance", "specularReflectance", 0.2);
  bsdf.exponent = properties.number("exponent").value_or(30);
  properties.finish();
  check_albedo(properties, diffuse.name, diffuse.colour);
  check_albedo(properties, specular.name, specular.colour);
  if (!(bsdf.exponent >= 0)) properties.reject("exponent", fmt::format("{}", bsdf.exponent), "0 or more");
  const Rgb sum = diffuse.colour + specular.colour;
  if (const double most = sum.maxCoeff(); most > 1 + 1e-9) {  // decimals that add up to 1 may round to more
    properties.reject(
        specular.name,
        fmt::format("({}, {}, {}), which with {} ({}, {}, {}) sums to {}", specular.colour[0], specular.colour[1],
                    specular.colour[2], diffuse.name, diffuse.colour[0], diffuse.colour[1], diffuse.colour[2], most),
        fmt::format("a sum up to 1 in each channel: divide both by {}", most));
  }
  bsdf.reflectance = diffuse.colour;
  bsdf.specular = specular.colour;
  return bsdf;
}

}  // namespace

Bsdf read_bsdf(const Element& element) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"diffuse", "roughconductor", "phong"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("bsdf", type, types);
  Properties properties(element, {});
  if (type == "phong") return read_phong(properties);
  if (type == "roughconductor") return read_rough_conductor(properties);
  Bsdf bsdf;
  bsdf.reflectance = properties.colour("reflectance").value_or(Rgb::Constant(0.5));
  properties.finish();
  check_albedo(properties, "reflectance", bsdf.reflectance);
  return bsdf;
}

}  // namespace halfslope
