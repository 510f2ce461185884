#include "host/lines/strokes/style.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "host/core/errors.h"
#include "host/imaging/png.h"
#include "host/lines/strokes/stroke_textures.h"

namespace exemplar {
namespace {

using testing::AllOf;
using testing::HasSubstr;
namespace fs = std::filesystem;

/// The one line that a bad style is refused with.
std::string refusal(const std::string& text) {
    try {
        parse_style(text, "my.json", fs::temp_directory_path());
    } catch (const DataError& error) {
        return error.what();
    }
    return "no DataError";
}

class BuiltinStyle : public testing::TestWithParam<std::string_view> {};

TEST_P(BuiltinStyle, IsAStyleFileLikeAnyOther) {
    const DrawingStyle style = load_style(std::string(GetParam()));
    EXPECT_EQ(style.name, GetParam());
    ASSERT_TRUE(style.background.has_value());
    for (const LineType type : k_line_types) {
        EXPECT_GT(style.of(type).thickness.width, 0);
        EXPECT_NE(style.of(type).color, *style.background);  // else nothing would be seen
        EXPECT_NO_THROW(load_stroke_texture(style.of(type).texture));
    }
}

INSTANTIATE_TEST_SUITE_P(All, BuiltinStyle, testing::ValuesIn(builtin_style_names()),
                         [](const auto& name) { return std::string(name.param); });

TEST(Styles, SetWhatTheySayAndNothingElse) {
    const DrawingStyle style = parse_style(R"({
        // what is not said is as in LineStyle
        "about": "a test", "background": "#1a2B3c", "fade": 0.5,
        "surface": {"shading": "toon", "color": "#fff"},
        "default": {"color": "red", "width": 3},
        "valleys": {"color": "#0f0", "opacity": 0.5, "threshold": 0.2, "texture": "pencil"},
        "creases": {"least": 0.1, "most": 7, "taper": 0, "epsilon": 2, "threshold": 90}
    })",
                                           "my.json", {});
    EXPECT_EQ(style.background, (Color{0x1a, 0x2b, 0x3c}));
    EXPECT_EQ(style.shading, SurfaceShading::toon);
    EXPECT_EQ(style.surface, (Color{255, 255, 255}));
    EXPECT_EQ(style.of(LineType::contours).color, (Color{255, 0, 0}));
    EXPECT_EQ(style.of(LineType::contours).thickness.width, 3);
    EXPECT_EQ(style.of(LineType::contours).thickness.taper, StrokeThickness{}.taper);
    EXPECT_EQ(style.of(LineType::contours).texture, "none");
    const LineStyle& valleys = style.of(LineType::valleys);
    EXPECT_EQ(valleys.color, (Color{0, 255, 0}));
    EXPECT_EQ(valleys.opacity, 0.5f);
    EXPECT_EQ(valleys.thickness.width, 3);
    EXPECT_EQ(valleys.texture, "pencil");
    const StrokeThickness& creases = style.of(LineType::creases).thickness;
    EXPECT_EQ(creases.least, 0.1f);
    EXPECT_EQ(creases.most, 7);
    EXPECT_EQ(creases.taper, 0);
    EXPECT_EQ(creases.epsilon, 2);
    EXPECT_EQ(style.thresholds(LineType::valleys).ridges_valleys, 0.2f);
    EXPECT_EQ(style.thresholds(LineType::ridges).ridges_valleys, LineThresholds{}.ridges_valleys);
    EXPECT_NEAR(style.thresholds(LineType::creases).crease_angle, std::numbers::pi / 2, 1e-6);
    EXPECT_EQ(style.thresholds(LineType::contours).fade, 0.5f);
}

TEST(Styles, OfNothingAreTheDefaults) {
    const DrawingStyle style = parse_style("{}", "my.json", {});
    EXPECT_FALSE(style.background.has_value());
    EXPECT_EQ(parse_style(R"({"background": "none"})", "my.json", {}).background, std::nullopt);
    EXPECT_EQ(style.fade, LineThresholds{}.fade);
}

TEST(Styles, SayWhereJsonIsBroken) {
    EXPECT_THAT(refusal("{\n  \"fade\": 1,\n  \"background\" \"#fff\"\n}"), HasSubstr("my.json:3:"));
    EXPECT_THAT(refusal(""), AllOf(HasSubstr("my.json:1:1:"), HasSubstr("JSON")));
    EXPECT_THAT(refusal("{\"fade\": 1"), HasSubstr("my.json:1:"));
    EXPECT_THAT(refusal("\xff\xfe{}"), HasSubstr("my.json:1:"));
    EXPECT_THAT(refusal("{\"fade\": 1e999}"), HasSubstr("my.json:"));
    EXPECT_THAT(refusal("{\"about\": \"\n\"}"), HasSubstr("my.json:1:"));
    for (const char* text : {"", "{", "[", "\"", "nul", "{\"\xff\": 1}", "{\"a\": \"\x01\"}", "{} {}"}) {
        const std::string line = refusal(text);
        EXPECT_THAT(line, HasSubstr("my.json:"));
        EXPECT_TRUE(std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c <= '~'; })) << line;
    }
}

TEST(Styles, NameUnknownKeysAndTheNearest) {
    EXPECT_THAT(refusal(R"({"backgroud": "#fff"})"), AllOf(HasSubstr("'backgroud'"), HasSubstr("'background'")));
    EXPECT_THAT(refusal(R"({"contour": {}})"), HasSubstr("'contours'"));
    EXPECT_THAT(refusal(R"({"ridges": {"colour": "red"}})"), AllOf(HasSubstr("/ridges:"), HasSubstr("'color'")));
    EXPECT_THAT(refusal(R"({"surface": {"shade": "toon"}})"), AllOf(HasSubstr("/surface:"), HasSubstr("shading")));
    EXPECT_THAT(refusal(R"({"contours": {"threshold": 1}})"), AllOf(HasSubstr("/contours:"), HasSubstr("threshold")));
    EXPECT_THAT(refusal(R"({"default": {"threshold": 1}})"), HasSubstr("/default:"));
    EXPECT_THAT(refusal(R"({"fade": 1, "fade": 2})"), HasSubstr("'fade' twice"));
    EXPECT_THAT(refusal(R"({"ridges": {"width": 1, "width": 2}})"), HasSubstr("'width' twice"));
}

TEST(Styles, NameValuesThatAreNone) {
    EXPECT_THAT(refusal("[]"), HasSubstr("array"));
    EXPECT_THAT(refusal(R"({"ridges": 3})"), AllOf(HasSubstr("/ridges"), HasSubstr("object")));
    EXPECT_THAT(refusal(R"({"ridges": {"width": "thick"}})"), AllOf(HasSubstr("/ridges/width"), HasSubstr("number")));
    EXPECT_THAT(refusal(R"({"ridges": {"width": 0}})"), AllOf(HasSubstr("/ridges/width"), HasSubstr("range")));
    EXPECT_THAT(refusal(R"({"ridges": {"width": -2}})"), HasSubstr("/ridges/width"));
    EXPECT_THAT(refusal(R"({"ridges": {"opacity": 1.5}})"), AllOf(HasSubstr("/ridges/opacity"), HasSubstr("to 1")));
    EXPECT_THAT(refusal(R"({"creases": {"threshold": 200}})"), HasSubstr("to 180"));
    EXPECT_THAT(refusal(R"({"fade": true})"), HasSubstr("/fade"));
    EXPECT_THAT(refusal(R"({"fade": null})"), HasSubstr("/fade"));
    EXPECT_THAT(refusal(R"({"about": 3})"), HasSubstr("/about"));
    EXPECT_THAT(refusal(R"({"ridges": {"least": 9, "most": 2}})"), AllOf(HasSubstr("/ridges"), HasSubstr("least")));
    EXPECT_THAT(refusal(R"({"default": {"least": 9}})"), HasSubstr("least"));
    EXPECT_THAT(refusal(R"({"surface": {"shading": "toom"}})"),
                AllOf(HasSubstr("/surface/shading"), HasSubstr("'toon'")));
}

TEST(Styles, NameColorsThatAreNone) {
    for (const char* color : {"#12", "#12345", "#gggggg", "123456", "#1234567", "", "#", "#\xc3\xa9z0"})
        EXPECT_THAT(refusal(std::string(R"({"default": {"color": ")") + color + "\"}}"),
                    AllOf(HasSubstr("/default/color"), HasSubstr("#rrggbb")));
    EXPECT_THAT(refusal(R"({"background": "whit"})"), AllOf(HasSubstr("/background"), HasSubstr("'white'")));
    EXPECT_THAT(refusal(R"({"background": 7})"), HasSubstr("/background"));
}

TEST(Styles, FindTexturesBesideThem) {
    const fs::path folder = fs::path(testing::TempDir()) / "styles";
    fs::create_directories(folder);
    write_png(folder / "dots.png", Image(4, 4, 1, 0));
    std::ofstream(folder / "my.json") << R"({"default": {"texture": "dots.png"}})";
    const DrawingStyle style = load_style((folder / "my.json").string());
    EXPECT_EQ(style.of(LineType::ridges).texture, (folder / "dots.png").string());
    EXPECT_THAT(refusal(R"({"default": {"texture": "no.png"}})"),
                AllOf(HasSubstr("/default/texture"), HasSubstr("no.png")));
    EXPECT_THAT(refusal(R"({"default": {"texture": "pensil"}})"), HasSubstr("'pencil'"));
    fs::remove_all(folder);
}

TEST(Styles, ThatAreNotThereNameTheNearest) {
    const auto refused = [](const std::string& name) {
        try {
            load_style(name);
        } catch (const DataError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_THAT(refused("pensil"), AllOf(HasSubstr("pensil:"), HasSubstr("'pencil'"), HasSubstr("blueprint")));
    EXPECT_THAT(refused("nowhere/style.json"), HasSubstr("nowhere/style.json:"));
    EXPECT_THAT(refused(testing::TempDir()), HasSubstr(testing::TempDir()));
    EXPECT_THROW(builtin_style_text("pensil"), UsageError);
}

TEST(Thresholds, AreSetByType) {
    LineThresholds thresholds;
    for (const LineType type : k_line_types) {
        if (!has_threshold(type)) {
            EXPECT_THROW(set_threshold(thresholds, type, 0.5f), UsageError);
            continue;
        }
        set_threshold(thresholds, type, 0.5f);
        for (const float wrong : {-1.0f, std::nanf(""), HUGE_VALF})
            EXPECT_THROW(set_threshold(thresholds, type, wrong), UsageError);
    }
    EXPECT_EQ(thresholds.suggestive_contours, 0.5f);
    EXPECT_EQ(thresholds.suggestive_highlights, 0.5f);
    EXPECT_EQ(thresholds.principal_highlights, 0.5f);
    EXPECT_EQ(thresholds.ridges_valleys, 0.5f);
    EXPECT_EQ(thresholds.apparent_ridges, 0.5f);
    EXPECT_NEAR(thresholds.crease_angle, std::numbers::pi / 360, 1e-6);
}

TEST(StrokeTextures, AreTheSameEachTimeAndMostlyInk) {
    for (const std::string_view name : stroke_texture_names()) {
        const Image image = load_stroke_texture(std::string(name));
        EXPECT_EQ(image, load_stroke_texture(std::string(name)));
        EXPECT_EQ(image.width, 256);
        EXPECT_EQ(image.height, 32);
        EXPECT_EQ(image.channels, 1);
        double middle = 0, rim = 0, seam = 0, steps = 0;
        for (int x = 0; x < 256; ++x) {
            middle += image.pixel(x, 16)[0] / 256.0 / 255;
            rim += image.pixel(x, 0)[0] / 256.0 / 255;
        }
        for (int y = 0; y < 32; ++y) {
            seam += std::abs(image.pixel(0, y)[0] - image.pixel(255, y)[0]);
            for (int x = 0; x < 255; ++x) steps += std::abs(image.pixel(x, y)[0] - image.pixel(x + 1, y)[0]) / 255.0;
        }
        EXPECT_GT(middle, 0.5) << name;
        EXPECT_LT(rim, middle) << name;
        EXPECT_LT(seam, 2 * steps + 200) << name;  // its ends fit as well as any two columns
    }
}

TEST(StrokeTextures, AreSampledAroundAndAcross) {
    Image image(4, 2, 1, 0);
    for (int x = 0; x < 4; ++x) image.pixel(x, 1)[0] = static_cast<std::uint8_t>(60 * (x + 1));
    EXPECT_EQ(sample_stroke_texture({}, 3, 0), 1);
    EXPECT_NEAR(sample_stroke_texture(image, 1.5f, 0.5f), 120 / 255.0, 1e-5);
    EXPECT_NEAR(sample_stroke_texture(image, 1.5f + 8, 1), 120 / 255.0, 1e-5);
    EXPECT_NEAR(sample_stroke_texture(image, 1.5f - 4, 1), 120 / 255.0, 1e-5);
    EXPECT_NEAR(sample_stroke_texture(image, 4, 1), 150 / 255.0, 1e-5);  // half way from the last to the first
    EXPECT_NEAR(sample_stroke_texture(image, 1.5f, 0), 60 / 255.0, 1e-5);
    EXPECT_EQ(sample_stroke_texture(image, 2, -1), 0);
}

TEST(StrokeTextures, OfFilesAreAlphaOrDarkness) {
    const fs::path path = fs::path(testing::TempDir()) / "texture.png";
    Image gray(2, 1, 1, 0);
    gray.pixel(1, 0)[0] = 200;
    write_png(path, gray);
    EXPECT_EQ(load_stroke_texture(path.string()).data, (std::vector<std::uint8_t>{255, 55}));
    Image clear(1, 1, 4, 0);
    clear.pixel(0, 0)[3] = 77;
    write_png(path, clear);
    EXPECT_EQ(load_stroke_texture(path.string()).data, (std::vector<std::uint8_t>{77}));
    fs::remove(path);
    EXPECT_THROW(load_stroke_texture(path.string()), DataError);
}

}  // namespace
}  // namespace exemplar
