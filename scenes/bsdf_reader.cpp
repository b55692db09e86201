#include <algorithm>
#include <string>
#include <vector>

#include "scenes/materials.h"
#include "scenes/readers.h"

namespace halfslope {
namespace {

std::string spelled(const Rgb& colour) { return fmt::format("({}, {}, {})", colour[0], colour[1], colour[2]); }

/// A property from 0 to 1 in each channel, as a colour or a texture.
void read_albedo(Properties& properties, const std::string& name, Reading& reading, Rgb& colour,
                 std::shared_ptr<const Texture>& texture) {
  read_colour(properties, name, reading, colour, texture);
  const char* allowed = "from 0 to 1 in each channel";
  const auto check = [&](const Rgb& value) {
    if (!((value >= 0).all() && (value <= 1).all())) properties.reject(name, spelled(value), allowed);
  };
  check(colour);
  if (!texture) return;
  if (texture->kind == Texture::Kind::kCheckerboard) {
    check(texture->color0);
    check(texture->color1);
    return;
  }
  for (std::size_t i = 0; i < texture->bitmap->rgb.size(); i += 3) {
    const float* rgb = texture->bitmap->rgb.data() + i;
    if (std::max({rgb[0], rgb[1], rgb[2]}) <= 1) continue;
    const std::size_t pixel = i / 3, width = static_cast<std::size_t>(texture->bitmap->width);
    properties.reject(
        name, fmt::format("{} at pixel ({}, {})", spelled({rgb[0], rgb[1], rgb[2]}), pixel % width, pixel / width),
        allowed);
  }
}

/// `alpha`, or `alpha_u` and `alpha_v`; Mitsuba's default is 0.1.
void read_alpha(Properties& properties, Bsdf& bsdf) {
  const auto alpha = properties.number("alpha"), u = properties.number("alpha_u"), v = properties.number("alpha_v");
  if (u.has_value() != v.has_value()) properties.reject(u ? "alpha_u" : "alpha_v", "alone", "both alpha_u and alpha_v");
  if (alpha && u) properties.reject("alpha", "given beside alpha_u and alpha_v", "one or the other");
  const auto check = [&](const char* name, double roughness) {
    if (roughness > 0 && roughness <= 1) return;
    properties.reject(name, fmt::format("{}", roughness), "above 0, up to 1");
  };
  bsdf.alpha = alpha ? *alpha : u.value_or(0.1);
  check(alpha ? "alpha" : "alpha_u", bsdf.alpha);
  if (v) check("alpha_v", *v);
  if (v && *v != bsdf.alpha) bsdf.alpha_v = v;
}

/// `distribution`, beckmann where there is none as in Mitsuba, and `sample_visible`, which only true is read of.
void read_distribution(Properties& properties, Bsdf& bsdf) {
  const std::string distribution = properties.string("distribution").value_or("beckmann");
  const auto sample_visible = properties.boolean("sample_visible");
  if (distribution != "ggx" && distribution != "beckmann") {
    properties.reject("distribution", fmt::format("'{}'", distribution), "ggx, beckmann");
  }
  if (sample_visible == false) properties.reject("sample_visible", "false", "true");
  bsdf.distribution = distribution == "ggx" ? Distribution::kGgx : Distribution::kBeckmann;
}

/// Material "none" (Mitsuba's default) is a perfect mirror's F = 1; otherwise a metal, or eta and k.
void read_metal(Properties& properties, Bsdf& bsdf) {
  const auto material = properties.string("material");
  const auto eta = properties.colour("eta"), k = properties.colour("k");
  if (material && (eta || k)) properties.reject("material", "given beside eta or k", "one or the other");
  bsdf.unit_fresnel = !eta && !k && material.value_or("none") == "none";
  if (bsdf.unit_fresnel) return;
  if (material) {
    const auto metal = find_metal(*material);
    if (!metal) {
      std::vector<std::string> names = metal_names();
      properties.reject("material", fmt::format("'{}'", *material),
                        fmt::format("none, {}, or eta and k instead of a material{}", comma_separated(names),
                                    did_you_mean(*material, names)));
    }
    bsdf.eta = metal->eta;
    bsdf.k = metal->k;
    return;
  }
  if (!eta || !k) properties.reject(eta ? "eta" : "k", "alone", "both eta and k");
  bsdf.eta = *eta;
  bsdf.k = *k;
  if (!((*eta >= 0).all() && (*k >= 0).all() && (*eta + *k > 0).all())) {
    properties.reject("eta", "negative, or zero where k is zero", "eta >= 0 and k >= 0, not both 0");
  }
}

double read_ior(Properties& properties, const std::string& name, const std::string& absent) {
  const auto given = properties.number_or_name(name);
  if (given && given->number) {
    if (!(*given->number > 0)) properties.reject(name, fmt::format("{}", *given->number), "above 0, or a name");
    return *given->number;
  }
  const std::string material = given ? given->name : absent;
  if (const auto ior = find_ior(material)) return *ior;
  const std::vector<std::string> names = ior_names();
  properties.reject(name, fmt::format("'{}'", material),
                    fmt::format("a number above 0, {}{}", comma_separated(names), did_you_mean(material, names)));
}

/// int_ior over ext_ior. `differ`: where Mitsuba refuses equal ones.
double read_relative_ior(Properties& properties, const std::string& absent, bool differ) {
  const double inside = read_ior(properties, "int_ior", absent), outside = read_ior(properties, "ext_ior", "air");
  if (differ && inside == outside) {
    properties.reject("int_ior", fmt::format("{}, and so is ext_ior", inside), "two that differ");
  }
  return inside / outside;
}

Bsdf read_diffuse(Properties& properties, Reading& reading) {
  Bsdf bsdf;
  properties.know({"reflectance"});
  properties.finish();
  read_albedo(properties, "reflectance", reading, bsdf.reflectance, bsdf.reflectance_texture);
  return bsdf;
}

Bsdf read_conductor(Properties& properties, Reading& reading, bool rough) {
  Bsdf bsdf;
  bsdf.kind = rough ? BsdfKind::kRoughConductor : BsdfKind::kConductor;
  bsdf.reflectance = Rgb::Ones();
  if (rough) properties.know({"distribution", "sample_visible"});
  properties.know({"specular_reflectance", "material", "eta", "k"});
  if (rough) properties.know({"alpha", "alpha_u", "alpha_v"});
  properties.finish();
  if (rough) read_distribution(properties, bsdf);
  read_albedo(properties, "specular_reflectance", reading, bsdf.reflectance, bsdf.reflectance_texture);
  if (rough) read_alpha(properties, bsdf);
  read_metal(properties, bsdf);
  return bsdf;
}

Bsdf read_plastic(Properties& properties, Reading& reading, bool rough) {
  Bsdf bsdf;
  bsdf.kind = rough ? BsdfKind::kRoughPlastic : BsdfKind::kPlastic;
  bsdf.specular = Rgb::Ones();
  properties.know({"diffuse_reflectance", "specular_reflectance", "int_ior", "ext_ior", "nonlinear"});
  if (rough) properties.know({"distribution", "sample_visible", "alpha"});
  properties.finish();
  if (rough) {
    read_distribution(properties, bsdf);
    read_alpha(properties, bsdf);
  }
  read_albedo(properties, "diffuse_reflectance", reading, bsdf.reflectance, bsdf.reflectance_texture);
  read_albedo(properties, "specular_reflectance", reading, bsdf.specular, bsdf.specular_texture);
  bsdf.nonlinear = properties.boolean("nonlinear").value_or(false);
  bsdf.ior = read_relative_ior(properties, "polypropylene", rough);
  if (rough && bsdf.ior < 1) {
    // Its model would give back more light than it gets.
    properties.reject("int_ior", fmt::format("{:.6g} of ext_ior", bsdf.ior), "the larger of the two");
  }
  return bsdf;
}

Bsdf read_dielectric(Properties& properties, Reading& reading, bool rough) {
  Bsdf bsdf;
  bsdf.kind = rough ? BsdfKind::kRoughDielectric : BsdfKind::kDielectric;
  bsdf.specular = Rgb::Ones();
  properties.know({"int_ior", "ext_ior", "specular_reflectance", "specular_transmittance"});
  if (rough) properties.know({"distribution", "sample_visible", "alpha", "alpha_u", "alpha_v"});
  properties.finish();
  if (rough) {
    read_distribution(properties, bsdf);
    read_alpha(properties, bsdf);
  }
  read_albedo(properties, "specular_reflectance", reading, bsdf.specular, bsdf.specular_texture);
  read_albedo(properties, "specular_transmittance", reading, bsdf.transmittance, bsdf.transmittance_texture);
  bsdf.ior = read_relative_ior(properties, "bk7", rough);
  return bsdf;
}

/// Of two spellings the one that is given: Mitsuba 3's or Mitsuba 0.6's.
std::string either(Properties& properties, const std::string& snake, const std::string& camel) {
  properties.know({snake, camel});
  if (properties.has(snake) && properties.has(camel)) {
    properties.reject(camel, fmt::format("given beside {}", snake), "one or the other");
  }
  return properties.has(camel) ? camel : snake;
}

/// The largest value that a colour reaches in each channel.
Rgb largest(const Rgb& colour, const std::shared_ptr<const Texture>& texture) {
  if (!texture) return colour;
  if (texture->kind == Texture::Kind::kCheckerboard) return texture->color0.max(texture->color1);
  Rgb most = Rgb::Zero();
  const auto& rgb = texture->bitmap->rgb;
  for (std::size_t i = 0; i < rgb.size(); i += 3) most = most.max(Rgb(rgb[i], rgb[i + 1], rgb[i + 2]));
  return most;
}

/// Mitsuba 0.6's phong, with its defaults. It would scale a sum of reflectances above 1 down without a word.
Bsdf read_phong(Properties& properties, Reading& reading) {
  Bsdf bsdf;
  bsdf.kind = BsdfKind::kPhong;
  bsdf.specular = Rgb::Constant(0.2);
  const std::string diffuse = either(properties, "diffuse_reflectance", "diffuseReflectance");
  const std::string specular = either(properties, "specular_reflectance", "specularReflectance");
  properties.know({"exponent"});
  properties.finish();
  read_albedo(properties, diffuse, reading, bsdf.reflectance, bsdf.reflectance_texture);
  read_albedo(properties, specular, reading, bsdf.specular, bsdf.specular_texture);
  bsdf.exponent = properties.number("exponent").value_or(30);
  if (!(bsdf.exponent >= 0)) properties.reject("exponent", fmt::format("{}", bsdf.exponent), "0 or more");
  const Rgb most_diffuse = largest(bsdf.reflectance, bsdf.reflectance_texture),
            most_specular = largest(bsdf.specular, bsdf.specular_texture);
  if (const double most = (most_diffuse + most_specular).maxCoeff(); most > 1 + 1e-9) {  // decimals may round to more
    properties.reject(
        specular,
        fmt::format("{}, which with {} {} sums to {}", spelled(most_specular), diffuse, spelled(most_diffuse), most),
        fmt::format("a sum up to 1 in each channel: divide both by {}", most));
  }
  return bsdf;
}

/// The bsdfs inside twosided or mask, before they are read: that they are what may stand there also means that none
/// holds itself.
std::vector<Element> nested_bsdfs(const Properties& properties, std::size_t most,
                                  std::initializer_list<std::string_view> refused) {
  const std::vector<Element> nested = properties.objects("bsdf");
  const Element& around = properties.element();
  const std::string type = around.attribute("type");
  if (nested.empty() || nested.size() > most) {
    around.error("{} bsdfs inside bsdf '{}', allowed: {}", nested.size(), type, most == 1 ? "1" : "1 or 2");
  }
  for (const Element& inner : nested) {
    const std::string found = inner.attribute("type");
    if (std::find(refused.begin(), refused.end(), found) == refused.end()) continue;
    around.error("bsdf '{}' inside bsdf '{}', allowed: any but {}", found, type, comma_separated(refused));
  }
  return nested;
}

Material read_two_sided(Properties& properties, Reading& reading) {
  properties.finish();
  const auto nested = nested_bsdfs(properties, 2, {"twosided", "mask", "dielectric", "roughdielectric"});
  const Bsdf front = read_bsdf(nested.front(), reading).front;
  return {front, nested.size() == 2 ? read_bsdf(nested.back(), reading).front : front};
}

/// The opacity is one number: of a picture its luminance, as in Mitsuba.
Material read_mask(Properties& properties, Reading& reading) {
  properties.know({"opacity"});
  properties.finish();
  const auto nested = nested_bsdfs(properties, 1, {"mask"});
  Material material = read_bsdf(nested.front(), reading);
  Rgb opacity = Rgb::Constant(0.5);
  std::shared_ptr<const Texture> texture;
  read_albedo(properties, "opacity", reading, opacity, texture);
  for (Bsdf* side : {&material.front, material.back ? &*material.back : nullptr}) {
    if (!side) continue;
    side->opacity = luminance(opacity);
    side->opacity_texture = texture ? luminance(texture) : nullptr;
  }
  return material;
}

}  // namespace

Material read_bsdf(const Element& element, Reading& reading) {
  const std::string type = element.attribute("type");
  const std::vector<std::string> types = {"diffuse",    "conductor",       "roughconductor", "plastic",  "roughplastic",
                                          "dielectric", "roughdielectric", "phong",          "twosided", "mask"};
  if (std::find(types.begin(), types.end(), type) == types.end()) element.unknown("bsdf", type, types);
  if (type == "twosided" || type == "mask") {
    Properties properties(element, {"bsdf", "ref", "texture"});
    return type == "mask" ? read_mask(properties, reading) : read_two_sided(properties, reading);
  }
  Properties properties(element, {"texture", "ref"});
  if (type == "diffuse") return {read_diffuse(properties, reading)};
  if (type == "phong") return {read_phong(properties, reading)};
  const bool rough = type.starts_with("rough");
  if (type.ends_with("conductor")) return {read_conductor(properties, reading, rough)};
  if (type.ends_with("plastic")) return {read_plastic(properties, reading, rough)};
  return {read_dielectric(properties, reading, rough)};
}

}  // namespace halfslope
