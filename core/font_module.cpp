// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/font_module.h"

#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include <memory>

namespace pnr {

namespace {

struct Drawing {
    std::vector<GlyphCurve>& curves;
    double scale;
    Vec2 start{0}, at{0};

    Vec2 place(const FT_Vector* v) const { return scale * Vec2(v->x, v->y); }
    void add(int degree, const std::array<Vec2, 4>& points) {
        curves.push_back({degree, points});
        at = points[static_cast<std::size_t>(degree)];
    }
    void close() {
        if (at != start) add(1, {at, start});
    }
};

Drawing& drawing(void* user) { return *static_cast<Drawing*>(user); }

int move_to(const FT_Vector* to, void* user) {
    Drawing& d = drawing(user);
    d.close();
    d.start = d.at = d.place(to);
    return 0;
}
int line_to(const FT_Vector* to, void* user) {
    Drawing& d = drawing(user);
    d.add(1, {d.at, d.place(to)});
    return 0;
}
int conic_to(const FT_Vector* control, const FT_Vector* to, void* user) {
    Drawing& d = drawing(user);
    d.add(2, {d.at, d.place(control), d.place(to)});
    return 0;
}
int cubic_to(const FT_Vector* c1, const FT_Vector* c2, const FT_Vector* to, void* user) {
    Drawing& d = drawing(user);
    d.add(3, {d.at, d.place(c1), d.place(c2), d.place(to)});
    return 0;
}

// Fonts of symbols have their letters from 0xF000 on.
FT_UInt glyph_index(FT_Face face, char32_t letter) {
    const FT_UInt index = FT_Get_Char_Index(face, letter);
    return index != 0 || letter > 0xff ? index : FT_Get_Char_Index(face, 0xf000 + letter);
}

bool read_glyph(FT_Face face, FT_UInt index, double scale, FontGlyph& glyph) {
    if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE) != 0) return false;
    glyph.advance = scale * static_cast<double>(face->glyph->metrics.horiAdvance);
    glyph.bearing = scale * static_cast<double>(face->glyph->metrics.horiBearingX);
    if (face->glyph->format != FT_GLYPH_FORMAT_OUTLINE) return false;
    Drawing d{glyph.curves, scale};
    const FT_Outline_Funcs calls{move_to, line_to, conic_to, cubic_to, 0, 0};
    if (FT_Outline_Decompose(&face->glyph->outline, &calls, &d) != 0) return false;
    d.close();
    return true;
}

std::string read_glyphs(const std::string& file, const std::u32string& letters,
                        std::vector<FontGlyph>& glyphs) {
    FT_Library opened = nullptr;
    if (FT_Init_FreeType(&opened) != 0) return "FreeType does not start";
    const std::unique_ptr<FT_LibraryRec_, decltype(&FT_Done_FreeType)> library(opened, &FT_Done_FreeType);
    FT_Face found = nullptr;
    if (FT_New_Face(opened, file.c_str(), 0, &found) != 0) return "it is not a font that FreeType can read";
    const std::unique_ptr<FT_FaceRec_, decltype(&FT_Done_Face)> face(found, &FT_Done_Face);
    if (!FT_IS_SCALABLE(found) || found->units_per_EM == 0) return "its letters have no outlines";
    if (!found->charmap && found->num_charmaps > 0) FT_Set_Charmap(found, found->charmaps[0]);
    const double scale = 1.0 / found->units_per_EM;
    FT_UInt before = 0;
    for (std::size_t i = 0; i < letters.size(); ++i) {
        FontGlyph& glyph = glyphs.emplace_back();
        const FT_UInt index = glyph_index(found, letters[i]);
        if (!read_glyph(found, index, scale, glyph)) return "one of its letters cannot be read";
        FT_Vector kerning{0, 0};
        if (i > 0 && FT_HAS_KERNING(found) &&
            FT_Get_Kerning(found, before, index, FT_KERNING_UNSCALED, &kerning) == 0)
            glyph.kerning = scale * static_cast<double>(kerning.x);
        before = index;
    }
    return "";
}

const FontModule functions{font_module_version, read_glyphs};

} // namespace

extern "C" __attribute__((visibility("default"))) const FontModule* pnr_font_module() { return &functions; }

} // namespace pnr
