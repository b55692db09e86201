// DejaVu Sans, which is compiled into the program (cmake/HalfslopeFonts.cmake): how wide text is, and what its letters
// look like.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

struct FT_LibraryRec_;
struct FT_FaceRec_;

namespace halfslope {

/// The bytes of a TrueType file.
std::span<const unsigned char> embedded_font(bool bold);

/// One weight of the font. Throws Error(kIo) where FreeType cannot open it.
class Typeface {
 public:
  explicit Typeface(bool bold);

  /// A letter, and how far right of the text's beginning its origin lies, in the font's own units.
  struct Glyph {
    unsigned index;
    long offset;
  };
  struct Line {
    std::vector<Glyph> glyphs;
    long width = 0;  ///< in the font's own units
  };
  /// A line of UTF-8 text, kerned; a letter that the font lacks is its empty box.
  Line set(std::string_view text) const;
  /// The font's own units in one em: a text of width w is w / units_per_em · size points wide.
  double units_per_em() const;
  FT_FaceRec_* face() const { return face_.get(); }
  FT_LibraryRec_* library() const { return library_.get(); }

 private:
  struct Free {
    void operator()(FT_LibraryRec_* library) const;
    void operator()(FT_FaceRec_* face) const;
  };
  std::unique_ptr<FT_LibraryRec_, Free> library_;
  std::unique_ptr<FT_FaceRec_, Free> face_;
};

/// Width of a line of text in points.
double text_width(std::string_view text, double size, bool bold = false);

}  // namespace halfslope
