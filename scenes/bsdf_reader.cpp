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

}  // namespace

Bsdf read_bsdf(const Element& element) {
  const std::string type = element.attribute("type");
  if (type != "diffuse" && type != "roughconductor") element.unknown("bsdf", type, {"diffuse", "roughconductor"});
  Properties properties(element, {});
  if (type == "roughconductor") return read_rough_conductor(properties);
  Bsdf bsdf;
  bsdf.reflectance = properties.colour("reflectance").value_or(Rgb::Constant(0.5));
  properties.finish();
  check_albedo(properties, "reflectance", bsdf.reflectance);
  return bsdf;
}

}  // namespace halfslope
