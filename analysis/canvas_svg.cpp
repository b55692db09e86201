#include <fmt/format.h>

#include <cmath>
#include <string_view>

#include "analysis/canvas.h"
#include "analysis/utf8.h"
#include "core/numbers.h"

namespace halfslope {
namespace {

// Thousandths of a point; the addition makes −0 a 0.
std::string number(double x) { return format_number(std::round(x * 1000) / 1000 + 0.0); }

std::string color(Ink ink) { return fmt::format("#{:02x}{:02x}{:02x}", ink.red, ink.green, ink.blue); }

// Text and attribute values alike; what XML 1.0 cannot hold becomes U+FFFD.
std::string escaped(std::string_view text) {
  std::string out;
  for (const char32_t c : decode_utf8(text)) {
    if (c == U'&') {
      out += "&amp;";
    } else if (c == U'<') {
      out += "&lt;";
    } else if (c == U'>') {
      out += "&gt;";
    } else if (c == U'"') {
      out += "&quot;";
    } else {
      const bool control = c < 0x20 && c != U'\t' && c != U'\n';
      append_utf8(out, control || c == 0xfffe || c == 0xffff ? kReplacementCharacter : c);
    }
  }
  return out;
}

// RFC 4648, section 4.
std::string base64(std::string_view bytes) {
  static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

std::string painted(const Paint& paint) {
  std::string text = fmt::format(" fill=\"{}\"", paint.fill ? color(*paint.fill) : "none");
  if (paint.fill && paint.opacity < 1) text += fmt::format(" fill-opacity=\"{}\"", number(paint.opacity));
  if (!paint.stroke) return text;
  text += fmt::format(" stroke=\"{}\" stroke-width=\"{}\"", color(paint.stroke->ink), number(paint.stroke->width));
  if (!paint.stroke->dashes.empty()) {
    std::string dashes;
    for (const double length : paint.stroke->dashes) dashes += (dashes.empty() ? "" : " ") + number(length);
    text += fmt::format(" stroke-dasharray=\"{}\"", dashes);
  }
  return text + " stroke-linejoin=\"round\"";
}

struct Writer {
  std::string& out;

  void operator()(const Canvas::Path& path) const {
    std::string points;
    for (const Position& p : path.points) points += (points.empty() ? "" : " ") + number(p.x) + "," + number(p.y);
    out += fmt::format("<{} points=\"{}\"{}/>\n", path.closed ? "polygon" : "polyline", points, painted(path.paint));
  }
  void operator()(const Canvas::Disc& disc) const {
    out += fmt::format("<circle cx=\"{}\" cy=\"{}\" r=\"{}\"{}/>\n", number(disc.center.x), number(disc.center.y),
                       number(disc.radius), painted(disc.paint));
  }
  void operator()(const Canvas::Text& text) const {
    const std::string x = number(text.baseline.x), y = number(text.baseline.y);
    out += fmt::format("<text x=\"{}\" y=\"{}\" font-size=\"{}\"", x, y, number(text.style.size));
    if (text.style.anchor != Anchor::kStart) {
      out += fmt::format(" text-anchor=\"{}\"", text.style.anchor == Anchor::kMiddle ? "middle" : "end");
    }
    if (text.style.bold) out += " font-weight=\"bold\"";
    if (text.style.ink != kBlack) out += fmt::format(" fill=\"{}\"", color(text.style.ink));
    if (text.style.degrees != 0)
      out += fmt::format(" transform=\"rotate({} {} {})\"", number(-text.style.degrees), x, y);
    out += fmt::format(" xml:space=\"preserve\">{}</text>\n", escaped(text.text));
  }
  // Twice: a viewer of SVG 1.1 knows the first value of image-rendering alone, a browser takes the last it knows.
  void operator()(const Canvas::Picture& picture) const {
    out += fmt::format(
        "<image x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" preserveAspectRatio=\"none\" "
        "style=\"image-rendering:optimizeSpeed;image-rendering:pixelated\" xlink:href=\"data:image/png;base64,{}\"/>\n",
        number(picture.top_left.x), number(picture.top_left.y), number(picture.width), number(picture.height),
        base64(encode_png(picture.image)));
  }
  void operator()(const Canvas::Group& group) const {
    out += fmt::format("<g><title>{}</title>\n", escaped(group.title));
  }
  void operator()(const Canvas::GroupEnd&) const { out += "</g>\n"; }
};

}  // namespace

std::string svg_text(const Canvas& canvas) {
  const std::string width = number(canvas.width()), height = number(canvas.height());
  std::string out = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" version=\"1.1\" "
      "width=\"{0}pt\" height=\"{1}pt\" viewBox=\"0 0 {0} {1}\" font-family=\"'DejaVu Sans', Verdana, sans-serif\">\n"
      "<rect width=\"{0}\" height=\"{1}\" fill=\"#ffffff\"/>\n",
      width, height);
  for (const Canvas::Element& element : canvas.elements()) std::visit(Writer{out}, element);
  return out + "</svg>\n";
}

}  // namespace halfslope
