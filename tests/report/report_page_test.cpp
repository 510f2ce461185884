#include "apps/report/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <regex>
#include <string_view>

#include "host/core/errors.h"
#include "host/core/files.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

fs::path page_path(const std::string& name) {
    fs::path path = fs::path(testing::TempDir()) / "exemplar_report" / (name + ".html");
    fs::remove(path);
    return path;
}

/// A mesh whose labels cycle through `classes`; every fifth face is wrong.
ReportMesh labeled(const std::string& name, const TriangleMesh& mesh, std::int32_t classes) {
    ReportMesh item;
    item.name = name;
    item.mesh = &mesh;
    for (std::size_t f = 0; f < mesh.face_count(); ++f) {
        const auto truth = static_cast<std::int32_t>(f % static_cast<std::size_t>(classes));
        item.truth.push_back(truth);
        item.predicted.push_back(f % 5 ? truth : (truth + 1) % classes);
        item.confidence.push_back(static_cast<float>(f % 101) / 100);
    }
    item.recognition_rate = 0.8;
    return item;
}

ReportData group_of(const TriangleMesh& mesh) {
    ReportData group;
    group.title = "Shapes";
    group.subtitle = "for tests";
    group.label_names = {"body", "arm", "leg"};
    group.label_colors = {{200, 0, 16}, {0, 180, 0}, {0, 0, 255}};
    group.meshes = {labeled("first", mesh, 3)};
    group.confusion = {0.3, 0.01, 0, 0, 0.4, 0.02, 0.07, 0, 0.2};
    group.feature_families = {{"curvature", 12}, {"spin images", 7}};
    group.first_features = {"curvature.k1.2", "spin.44"};
    group.timings = {{"features", 1.5}, {"cut", 0.002}};
    group.summary = {{"Recognition rate", "97.1%"}, {"Device", "none"}};
    return group;
}

std::string written(const fs::path& path, const std::string& title, std::span<const ReportData> groups) {
    write_report_page(path, title, groups);
    return read_file(path);
}

/// The text of the element that `opening` begins, up to the next closing script tag.
std::string script_text(const std::string& page, const std::string& opening) {
    const std::size_t at = page.find(opening);
    if (at == std::string::npos) throw std::runtime_error("no element " + opening);
    const std::size_t begin = at + opening.size();
    return page.substr(begin, page.find("</script>", begin) - begin);
}
nlohmann::json report_json(const std::string& page) {
    return nlohmann::json::parse(script_text(page, "<script type=\"application/json\" id=\"report\">"));
}
std::string mesh_text(const std::string& page, const std::string& id) {
    return script_text(page, "<script type=\"text/plain\" id=\"" + id + "\">");
}

std::vector<std::uint8_t> decode_base64(const std::string& text) {
    const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    EXPECT_EQ(text.size() % 4, 0u);
    std::vector<std::uint8_t> bytes;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=') break;
        const std::size_t digit = digits.find(c);
        EXPECT_NE(digit, std::string_view::npos);
        bits = bits << 6 | static_cast<std::uint32_t>(digit & 63);
        count += 6;
        if (count >= 8) bytes.push_back(static_cast<std::uint8_t>(bits >> (count -= 8)));
    }
    return bytes;
}

/// Reads the bytes of a mesh block in order.
struct BlockReader {
    std::vector<std::uint8_t> bytes;
    std::size_t at = 0;
    std::uint32_t take(std::size_t size) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < size; ++i) value |= static_cast<std::uint32_t>(bytes.at(at++)) << (8 * i);
        return value;
    }
};

/// The stored positions of all vertices must be within half a quantization step.
void expect_positions(BlockReader& block, const nlohmann::json& description, const TriangleMesh& mesh) {
    for (const Vec3& vertex : mesh.vertices)
        for (int c = 0; c < 3; ++c) {
            const double step = description["step"][c], origin = description["origin"][c];
            ASSERT_NEAR(origin + step * block.take(2), vertex[c], 0.5001 * step + 1e-12);
        }
}
void expect_faces(BlockReader& block, const TriangleMesh& mesh, std::size_t index_size) {
    for (const Face& face : mesh.faces)
        for (const std::uint32_t v : face) ASSERT_EQ(block.take(index_size), v);
}

std::size_t occurrences(const std::string& text, const std::string& word) {
    std::size_t count = 0;
    for (std::size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
    return count;
}

TEST(ReportPage, NeedsNothingFromOutside) {
    const TriangleMesh mesh = shapes::icosphere(2, 1);
    const std::string page = written(page_path("alone"), "Report", std::vector{group_of(mesh)});
    EXPECT_THAT(page, testing::StartsWith("<!DOCTYPE html>"));
    EXPECT_THAT(page, HasSubstr("default-src 'none'"));
    EXPECT_THAT(page, testing::EndsWith("</html>\n"));
    for (const std::string reference :
         {"http://", "https://", "src=", "@import", "url(", "fetch(", "XMLHttpRequest", "{{"})
        EXPECT_THAT(page, Not(HasSubstr(reference))) << reference;
    const std::regex link("href=\"(?!data:)");
    EXPECT_FALSE(std::regex_search(page, link));
}

TEST(ReportPage, NamesCannotBreakOutOfTheirPlace) {
    const TriangleMesh mesh = shapes::icosphere(0, 1);
    const std::string plain = written(page_path("plain"), "Report", std::vector{group_of(mesh)});
    const std::string evil = "</script><script>alert(1)</script><!-- \"'&\\ {{data}} {{title}}";
    ReportData group = group_of(mesh);
    group.title = group.subtitle = group.label_names[1] = group.meshes[0].name = group.first_features[0] = evil;
    group.measures = {{evil, 0.5}};
    group.scores = {{evil, group.measures}};
    group.stage_features = {{evil, {{evil, 1}}}};
    group.curves = {{evil, {{1, 1, 1}}}};
    group.tables = {{evil, evil, {evil}, {{evil}}}};
    group.reference_name = group.feature_families[0].first = group.timings[0].first = group.summary[0].first =
        group.summary[0].second = evil;
    const std::string page = written(page_path("evil"), evil, std::vector{group});

    for (const std::string tag : {"<script", "</script", "<!--"})
        EXPECT_EQ(occurrences(page, tag), occurrences(plain, tag)) << tag;
    EXPECT_THAT(
        page,
        HasSubstr("<title>&lt;/script&gt;&lt;script&gt;alert(1)&lt;/script&gt;&lt;!-- &quot;&#39;&amp;\\ {{data}}"));
    const nlohmann::json report = report_json(page);
    EXPECT_EQ(report["title"], evil);
    const nlohmann::json& shown = report["groups"][0];
    for (const nlohmann::json& name :
         {shown["title"], shown["subtitle"], shown["labels"][1], shown["meshes"][0]["name"], shown["features"][0],
          shown["families"][0][0], shown["timings"][0][0], shown["measures"][0]["name"], shown["scores"][0]["name"],
          shown["stages"][0]["stage"], shown["curves"][0]["name"], shown["reference"], shown["summary"][0][0],
          shown["summary"][0][1], shown["tables"][0]["title"], shown["tables"][0]["note"],
          shown["tables"][0]["columns"][0], shown["tables"][0]["rows"][0][0]})
        EXPECT_EQ(name, evil);
}

TEST(ReportPage, AcceptsNamesThatAreNotUtf8) {
    const TriangleMesh mesh = shapes::icosphere(0, 1);
    ReportData group = group_of(mesh);
    group.label_names[0] = "caf\xe9";
    group.label_names[1] =
        "stra\xc3\x9f"
        "e";
    const nlohmann::json report = report_json(written(page_path("latin"), "Report", std::vector{group}));
    EXPECT_EQ(report["groups"][0]["labels"][0], "caf\xef\xbf\xbd");
    EXPECT_EQ(report["groups"][0]["labels"][1],
              "stra\xc3\x9f"
              "e");
}

TEST(ReportPage, MeshBlocksDecodeToTheMesh) {
    TriangleMesh mesh = shapes::translated(shapes::box(3, 0.5f, 7, 5), {100, -20, 3});
    ReportData group = group_of(mesh);
    ReportMesh& item = group.meshes[0];
    item.truth[4] = -1;
    item.confidence[0] = 1.0f + 1e-6f;
    item.entropy.assign(item.confidence.rbegin(), item.confidence.rend());
    item.border.assign(item.confidence.size(), 0.25F);
    const std::string page = written(page_path("decode"), "Report", std::vector{group});
    const nlohmann::json description = report_json(page)["groups"][0]["meshes"][0];
    EXPECT_EQ(description["vertices"], mesh.vertex_count());
    EXPECT_EQ(description["faces"], mesh.face_count());
    EXPECT_EQ(description["truth"], true);
    EXPECT_EQ(description["unlabeled"], true);
    EXPECT_EQ(description["hasEntropy"], true);
    EXPECT_EQ(description["hasBorder"], true);
    EXPECT_EQ(description["rate"], 0.8);

    BlockReader block{decode_base64(mesh_text(page, "mesh-0-0"))};
    ASSERT_EQ(block.bytes.size(), 6 * mesh.vertex_count() + 11 * mesh.face_count());
    expect_positions(block, description, mesh);
    expect_faces(block, mesh, 2);
    for (const std::int32_t label : item.predicted) ASSERT_EQ(block.take(1), label);
    for (const std::int32_t label : item.truth) ASSERT_EQ(block.take(1), label < 0 ? 255 : label);
    for (const std::vector<float>* values : {&item.confidence, &item.entropy, &item.border})
        for (const float value : *values) ASSERT_NEAR(block.take(1) / 255.0, value, 0.5001 / 255);
    EXPECT_EQ(block.at, block.bytes.size());
}

TEST(ReportPage, MeshWithoutTruthIsSmallerAndHasNoRate) {
    const TriangleMesh mesh = shapes::torus(1, 0.3f, 12, 7);
    ReportData group = group_of(mesh);
    group.meshes[0].truth.clear();
    group.meshes[0].recognition_rate = std::numeric_limits<double>::quiet_NaN();
    const std::string page = written(page_path("no_truth"), "Report", std::vector{group});
    const nlohmann::json description = report_json(page)["groups"][0]["meshes"][0];
    EXPECT_EQ(description["truth"], false);
    EXPECT_EQ(description["unlabeled"], false);
    EXPECT_TRUE(description["rate"].is_null());
    EXPECT_EQ(decode_base64(mesh_text(page, "mesh-0-0")).size(), 6 * mesh.vertex_count() + 8 * mesh.face_count());
}

TEST(ReportPage, IndicesAreAsWideAsTheVertexCountNeeds) {
    for (const std::uint32_t extra : {0u, 1u}) {
        TriangleMesh mesh = shapes::grid(255, 1, 1);  // 512 vertices
        mesh.vertices.resize(65536 + extra, Vec3::Zero());
        mesh.faces.push_back({0, 1, 65535 + extra});
        const std::string page = written(page_path("wide"), "Report", std::vector{group_of(mesh)});
        BlockReader block{decode_base64(mesh_text(page, "mesh-0-0"))};
        expect_positions(block, report_json(page)["groups"][0]["meshes"][0], mesh);
        expect_faces(block, mesh, extra ? 4 : 2);
        EXPECT_EQ(block.bytes.size() - block.at, 3 * mesh.face_count());
    }
}

TEST(ReportPage, UnusedVerticesNeitherWidenTheBoxNorMatter) {
    TriangleMesh mesh = shapes::icosphere(1, 2);
    const std::size_t used = mesh.vertex_count();
    mesh.vertices.push_back({1e30f, -1e30f, 0});
    mesh.vertices.push_back(Vec3::Constant(std::numeric_limits<float>::quiet_NaN()));
    const std::string page = written(page_path("unused"), "Report", std::vector{group_of(mesh)});
    const nlohmann::json description = report_json(page)["groups"][0]["meshes"][0];
    for (int c = 0; c < 3; ++c) EXPECT_LE(description["step"][c], 4.0001 / 65535);
    BlockReader block{decode_base64(mesh_text(page, "mesh-0-0"))};
    mesh.vertices.resize(used);
    expect_positions(block, description, mesh);
}

TEST(ReportPage, FlatAndEmptyMeshesAreShown) {
    const TriangleMesh flat = shapes::grid(3, 2, 1), empty;
    ReportData group = group_of(flat);
    group.meshes.push_back(labeled("empty", empty, 3));
    const std::string page = written(page_path("flat"), "Report", std::vector{group});
    const nlohmann::json meshes = report_json(page)["groups"][0]["meshes"];
    EXPECT_EQ(meshes[0]["step"][2], 0.0);
    BlockReader block{decode_base64(mesh_text(page, "mesh-0-0"))};
    expect_positions(block, meshes[0], flat);
    EXPECT_EQ(mesh_text(page, "mesh-0-1"), "");
    EXPECT_EQ(meshes[1]["faces"], 0);
}

TEST(ReportPage, TablesArriveUnchangedAndGroupsStayApart) {
    const TriangleMesh one = shapes::icosphere(0, 1), other = shapes::icosphere(1, 1);
    std::vector<ReportData> groups{group_of(one), group_of(other)};
    groups[1].title = "Others";
    groups[1].confusion.clear();
    groups[1].timings[0].second = std::numeric_limits<double>::infinity();
    const std::string page = written(page_path("groups"), "Report", groups);
    const nlohmann::json report = report_json(page);
    ASSERT_EQ(report["groups"].size(), 2u);
    const nlohmann::json& first = report["groups"][0];
    EXPECT_EQ(first["colors"], (nlohmann::json{"#c80010", "#00b400", "#0000ff"}));
    EXPECT_EQ(first["confusion"].get<std::vector<double>>(), groups[0].confusion);
    EXPECT_EQ(first["families"], nlohmann::json::parse(R"([["curvature", 12], ["spin images", 7]])"));
    EXPECT_EQ(first["timings"], nlohmann::json::parse(R"([["features", 1.5], ["cut", 0.002]])"));
    EXPECT_TRUE(report["groups"][1]["timings"][0][1].is_null());
    EXPECT_EQ(report["groups"][1]["title"], "Others");
    EXPECT_EQ(decode_base64(mesh_text(page, "mesh-1-0")).size(), 6 * other.vertex_count() + 9 * other.face_count());
}

TEST(ReportPage, MeasuresScoresCurvesAndStagesArrive) {
    const TriangleMesh mesh = shapes::icosphere(0, 1);
    constexpr double k_unknown = std::numeric_limits<double>::quiet_NaN();
    std::vector<ReportData> groups{group_of(mesh)};
    groups[0].measures = {{"rate", 0.75, 0.5}, {"cut", 0.1, k_unknown, true, false}};
    groups[0].reference_name = "thesis";
    groups[0].scores = {{"first", {{"rate", k_unknown}}}, {"not drawn", {}}};
    groups[0].stage_features = {{"unary 0", {{"spin", 3}}}};
    groups[0].curves = {{"unary 0", {{1, 0.5, 0.25}, {7, k_unknown, 0.125}}, 7, false}};
    const std::string page = written(page_path("measures"), "Report", groups);
    const nlohmann::json group = report_json(page)["groups"][0];
    EXPECT_EQ(group["measures"], nlohmann::json::parse(R"([
        {"name": "rate", "value": 0.75, "reference": 0.5, "lower": false, "share": true},
        {"name": "cut", "value": 0.1, "reference": null, "lower": true, "share": false}])"));
    EXPECT_EQ(group["reference"], "thesis");
    ASSERT_EQ(group["scores"].size(), 2u);
    EXPECT_TRUE(group["scores"][0]["measures"][0]["value"].is_null());
    EXPECT_EQ(group["scores"][1], nlohmann::json::parse(R"({"name": "not drawn", "measures": []})"));
    EXPECT_EQ(group["stages"], nlohmann::json::parse(R"([{"stage": "unary 0", "families": [["spin", 3]]}])"));
    EXPECT_EQ(group["curves"], nlohmann::json::parse(R"([
        {"name": "unary 0", "points": [[1, 0.5, 0.25], [7, null, 0.125]], "chosen": 7, "kept": false}])"));
}

TEST(ReportPage, StaysSmallAndIsDeterministic) {
    const TriangleMesh mesh = shapes::torus(1, 0.4f, 100, 50);
    ASSERT_EQ(mesh.face_count(), 10000u);
    ReportData group = group_of(mesh);
    group.meshes.assign(24, group.meshes[0]);
    const std::string page = written(page_path("many"), "Report", std::vector{group});
    EXPECT_LT(page.size(), 5'000'000u);
    EXPECT_EQ(written(page_path("again"), "Report", std::vector{group}), page);
}

/// What `spoil` does to a good report must be refused with a message that holds `word`, and leave the old page alone.
template <typename Spoil>
void expect_refused(const std::string& word, Spoil&& spoil) {
    const TriangleMesh mesh = shapes::icosphere(1, 1);
    TriangleMesh bad = mesh;
    std::vector<ReportData> groups{group_of(bad)};
    const fs::path path = page_path("refused");
    write_file_atomically(path, [](std::ostream& out) { out << "old"; });
    spoil(groups, bad);
    try {
        write_report_page(path, "Report", groups);
        ADD_FAILURE() << "accepted: " << word;
    } catch (const UsageError& error) {
        EXPECT_THAT(error.what(), HasSubstr(word));
    }
    EXPECT_EQ(read_file(path), "old");
}

TEST(ReportPage, RefusesWhatDoesNotFit) {
    using Groups = std::vector<ReportData>;
    expect_refused("no group", [](Groups& g, TriangleMesh&) { g.clear(); });
    expect_refused("predicted label of face 7 is 3", [](Groups& g, TriangleMesh&) { g[0].meshes[0].predicted[7] = 3; });
    expect_refused("predicted label", [](Groups& g, TriangleMesh&) { g[0].meshes[0].predicted[7] = -1; });
    expect_refused("true label", [](Groups& g, TriangleMesh&) { g[0].meshes[0].truth[2] = -2; });
    expect_refused("true label", [](Groups& g, TriangleMesh&) { g[0].meshes[0].truth[2] = 1000; });
    expect_refused("mesh 'first'", [](Groups& g, TriangleMesh&) { g[0].meshes[0].predicted.pop_back(); });
    expect_refused("79 true labels", [](Groups& g, TriangleMesh&) { g[0].meshes[0].truth.pop_back(); });
    expect_refused("0 confidences", [](Groups& g, TriangleMesh&) { g[0].meshes[0].confidence.clear(); });
    expect_refused("confidence of face 3", [](Groups& g, TriangleMesh&) { g[0].meshes[0].confidence[3] = 1.5f; });
    expect_refused("confidence of face 3", [](Groups& g, TriangleMesh&) { g[0].meshes[0].confidence[3] = NAN; });
    expect_refused("1 entropies", [](Groups& g, TriangleMesh&) { g[0].meshes[0].entropy = {0.5F}; });
    expect_refused("border of face 2", [](Groups& g, TriangleMesh&) {
        g[0].meshes[0].border.assign(80, -1), g[0].meshes[0].border[0] = g[0].meshes[0].border[1] = 0;
    });
    expect_refused("null", [](Groups& g, TriangleMesh&) { g[0].meshes[0].mesh = nullptr; });
    expect_refused("label colors", [](Groups& g, TriangleMesh&) { g[0].label_colors.pop_back(); });
    expect_refused("confusion", [](Groups& g, TriangleMesh&) { g[0].confusion.pop_back(); });
    expect_refused("confusion", [](Groups& g, TriangleMesh&) { g[0].confusion[1] = NAN; });
    for (const std::size_t rounds : {3u, 4u})
        expect_refused("curve 'unary 0' goes from 4 to", [&](Groups& g, TriangleMesh&) {
            g[0].curves = {{"unary 0", {{1, 1, 1}, {4, 1, 1}, {rounds, 1, 1}}}};
        });
    expect_refused("1 cells in a row", [](Groups& g, TriangleMesh&) {
        g[0].tables = {{"t", "", {"a", "b"}, {{"1"}}}};
    });
    expect_refused("256 labels", [](Groups& g, TriangleMesh&) { g[0].label_names.resize(256); });
    expect_refused("vertex 42 of 42", [](Groups&, TriangleMesh& m) { m.faces[9][1] = 42; });
    expect_refused("not finite", [](Groups&, TriangleMesh& m) { m.vertices[5][0] = INFINITY; });
}

TEST(ReportPage, DrawingsAreImagesInTheFile) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    const std::vector<ReportData> groups{group_of(mesh)};
    const fs::path path = page_path("drawings");
    const std::vector<ReportDrawing> drawings{
        {.title = "Lines & more", .text = "a < b", .svg = "<svg/>", .captions = {"left", "<right>"}}};
    write_report_page(path, "Report", groups, drawings);
    const std::string text = read_file(path);
    EXPECT_THAT(text, HasSubstr("data:image/svg+xml;base64,PHN2Zy8+\""));
    EXPECT_THAT(text, HasSubstr("<h2>Lines &amp; more</h2>"));
    EXPECT_THAT(text, HasSubstr("a &lt; b"));
    EXPECT_THAT(text, HasSubstr("<span>left</span><span>&lt;right&gt;</span>"));
    write_report_page(path, "Report", groups);
    EXPECT_THAT(read_file(path), Not(HasSubstr("svg+xml")));
}

}  // namespace
}  // namespace exemplar
