#include "host/imaging/svg.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <locale>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/mesh/color_text.h"

namespace exemplar {
namespace {

TEST(SvgNumbers, AreShort) {
    EXPECT_EQ(svg_number(0), "0");
    EXPECT_EQ(svg_number(-0.001), "0");
    EXPECT_EQ(svg_number(1.5), "1.5");
    EXPECT_EQ(svg_number(1.005), "1");  // its double is below
    EXPECT_EQ(svg_number(-2.999), "-3");
    EXPECT_EQ(svg_number(100), "100");
    EXPECT_EQ(svg_number(1e20), "100000000000000000000");
    EXPECT_EQ(svg_number(1e-9), "0");
    EXPECT_EQ(svg_number(0.123456789, 6), "0.123457");
    EXPECT_EQ(svg_number(12.6, 0), "13");
    EXPECT_EQ(svg_number(std::numeric_limits<double>::max()).size(), 309);
    EXPECT_THROW(svg_number(std::nan("")), UsageError);
    EXPECT_THROW(svg_number(HUGE_VAL), UsageError);
}

/// A locale that writes 1.5 as 1,5.
struct CommaPoint : std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    std::string do_grouping() const override { return "\3"; }
};

TEST(SvgNumbers, DoNotDependOnTheLocale) {
    const std::locale before = std::locale::global(std::locale(std::locale::classic(), new CommaPoint));
    const std::string number = svg_number(12345.25);
    SvgPath path(Vec2(3000, 3000));
    path.move_to({1.5f, 2000.25f});
    std::locale::global(before);
    EXPECT_EQ(number, "12345.25");
    EXPECT_EQ(path.data(), "M1.5 2000.25");
}

TEST(SvgText, IsEscaped) {
    EXPECT_EQ(svg_escaped("a < b & \"c\" > d"), "a &lt; b &amp; &quot;c&quot; &gt; d");
    EXPECT_EQ(svg_escaped("\xc3\xa9t\xc3\xa9"), "\xc3\xa9t\xc3\xa9");
    EXPECT_EQ(svg_escaped(std::string("a\x01\0b", 4)),
              "a\xEF\xBF\xBD\xEF\xBF\xBD"
              "b");
    EXPECT_EQ(svg_escaped("\xff"), "\xEF\xBF\xBD");
    EXPECT_EQ(hex_of_color({1, 171, 255}), "#01abff");
}

TEST(SvgDocuments, NestLayersAndGroups) {
    SvgDocument document(30, 20, "A & B");
    document.open_layer("ink", std::vector<SvgAttribute>{{"fill", "none"}});
    SvgPath path(Vec2(3000, 3000));
    path.move_to({0, 1});
    path.line_to({2.5f, -3});  // moved to the border
    path.curve_to({1, 2}, {3, 4}, {5, 6});
    path.close();
    document.add("path", std::vector<SvgAttribute>{{"d", path.data()}});
    document.open_layer("inner");
    document.close();
    EXPECT_THROW(document.text(), UsageError);
    document.close();
    EXPECT_EQ(document.text(),
              "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
              "<svg xmlns=\"http://www.w3.org/2000/svg\" "
              "xmlns:inkscape=\"http://www.inkscape.org/namespaces/inkscape\" version=\"1.1\" "
              "width=\"30px\" height=\"20px\" viewBox=\"0 0 30 20\">\n"
              "  <title>A &amp; B</title>\n"
              "  <g id=\"layer1\" inkscape:groupmode=\"layer\" inkscape:label=\"ink\" fill=\"none\">\n"
              "    <path d=\"M0 1L2.5 0C1 2 3 4 5 6Z\"/>\n"
              "    <g id=\"layer2\" inkscape:groupmode=\"layer\" inkscape:label=\"inner\">\n"
              "    </g>\n"
              "  </g>\n"
              "</svg>\n");
    EXPECT_THROW(document.close(), UsageError);
    EXPECT_THROW(SvgDocument(0, 20, ""), UsageError);
}

TEST(SvgDocuments, AreWrittenWholeOrNotAtAll) {
    const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "svg_test.svg";
    SvgDocument document(3, 2, "t");
    write_svg(path, document);
    EXPECT_EQ(read_file(path), document.text());
    document.open_layer("open");
    EXPECT_THROW(write_svg(path, document), UsageError);
    EXPECT_EQ(read_file(path).substr(0, 5), "<?xml");
    std::filesystem::remove(path);
    EXPECT_THROW(write_svg("/proc/no/such.svg", SvgDocument(3, 2, "t")), DataError);
}

}  // namespace
}  // namespace exemplar
