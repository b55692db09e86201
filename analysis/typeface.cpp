#include "analysis/typeface.h"

#include <ft2build.h>
#include FT_FREETYPE_H

#include "analysis/utf8.h"
#include "core/error.h"

namespace halfslope {

void Typeface::Free::operator()(FT_LibraryRec_* library) const { FT_Done_FreeType(library); }
void Typeface::Free::operator()(FT_FaceRec_* face) const { FT_Done_Face(face); }

Typeface::Typeface(bool bold) {
  FT_Library library = nullptr;
  if (FT_Init_FreeType(&library) != 0) fail(ExitCode::kIo, "FreeType does not start");
  library_.reset(library);
  const auto bytes = embedded_font(bold);
  FT_Face face = nullptr;
  if (FT_New_Memory_Face(library, bytes.data(), static_cast<FT_Long>(bytes.size()), 0, &face) != 0) {
    fail(ExitCode::kIo, "FreeType cannot open the font that halfslope was built with");
  }
  face_.reset(face);
}

Typeface::Line Typeface::set(std::string_view text) const {
  Line line;
  FT_UInt previous = 0;
  for (const char32_t c : decode_utf8(text)) {
    const FT_UInt index = FT_Get_Char_Index(face_.get(), c);
    FT_Vector kerning = {0, 0};
    if (previous != 0 && index != 0) FT_Get_Kerning(face_.get(), previous, index, FT_KERNING_UNSCALED, &kerning);
    line.width += kerning.x;
    line.glyphs.push_back({index, line.width});
    if (FT_Load_Glyph(face_.get(), index, FT_LOAD_NO_SCALE) == 0) line.width += face_->glyph->metrics.horiAdvance;
    previous = index;
  }
  return line;
}

double Typeface::units_per_em() const { return face_->units_per_EM; }

double text_width(std::string_view text, double size, bool bold) {
  const Typeface typeface(bold);
  return static_cast<double>(typeface.set(text).width) / typeface.units_per_em() * size;
}

}  // namespace halfslope
