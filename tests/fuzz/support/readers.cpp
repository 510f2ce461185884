#include "tests/fuzz/support/readers.h"

#include <fmt/format.h>
#include <turbojpeg.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "host/animation/check_animation.h"
#include "host/animation/read_formats.h"
#include "host/animation/write_animation.h"
#include "host/core/errors.h"
#include "host/core/files.h"
#include "host/curvature/model/model.h"
#include "host/data/catalog/shape_record.h"
#include "host/data/catalog/shard.h"
#include "host/data/corpus.h"
#include "host/data/safetensors.h"
#include "host/hatching/style/hatching_style.h"
#include "host/imaging/pictures/jpeg.h"
#include "host/imaging/pictures/tiff.h"
#include "host/imaging/png.h"
#include "host/imaging/vectors/svg_reader.h"
#include "host/labeling/category/category_model.h"
#include "host/labeling/inference/model.h"
#include "host/lines/strokes/style.h"
#include "host/mesh/io/io_formats.h"
#include "host/mesh/io/io_import.h"
#include "host/mesh/io/io_text.h"
#include "tests/fuzz/support/compressed.h"
#include "tests/fuzz/support/label_promises.h"
#include "tests/fuzz/support/promises.h"
#include "tests/support/mesh_files.h"

namespace exemplar::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr MemoryBound k_usual_bound{256 * 1024, 64};
/// Copies of a mesh cost a glTF file next to nothing, so 64 MiB of vertices and corners are free; the result takes up
/// to ten times as much.
constexpr MemoryBound k_gltf_bound{640 * 1024 * 1024, 1024};

/// Frames of clips between two keys cost next to nothing as well.
constexpr MemoryBound k_animation_bound{800 * 1024 * 1024, 4096};

/// exemplar-import may write 256 MiB for any file, and a still may take some times as much.
constexpr MemoryBound k_import_bound{std::size_t{2} << 30, 4096};

/// Where files are kept that a reader or writer wants to have a path; goes away with the program. In memory where that
/// is possible, as a disk would take most of the time. Holds what a glTF file or a list may name.
const fs::path& scratch() {
    static const fs::path path = [] {
        if (access("/dev/shm", W_OK) == 0) setenv("TEST_TMPDIR", "/dev/shm", 0);  // GoogleTest's name for /tmp
        static const mesh_files::TemporaryFolder folder;
        mesh_files::write_bytes(folder / "a.bin",
                                mesh_files::tetrahedron_positions() + mesh_files::tetrahedron_indices());
        mesh_files::write_bytes(folder / "a.off", "OFF\n0 0 0\n");
        mesh_files::write_bytes(folder / "b c.ply", "ply\n");
        return folder.path();
    }();
    return path;
}

fs::path scratch_file(const std::string& name, std::string_view content) {
    fs::path path = scratch() / name;
    mesh_files::write_bytes(path, std::string(content));
    return path;
}

bool same(float a, float b) {
    return a == b || (std::isnan(a) && std::isnan(b));
}

/// Returns how far a corner of a triangle may move when a mesh is written and read: 1/65536 of the extent each time, as
/// the origin is chosen anew (mesh_io::origin_for_floats).
double allowed_move(const TriangleMesh& mesh) {
    if (mesh.origin.isZero(0)) return 0;
    Eigen::AlignedBox3d box;
    for (const Face& face : mesh.faces)
        for (const std::uint32_t corner : face)
            if (mesh.vertices[corner].allFinite()) box.extend(mesh.vertices[corner].cast<double>());
    return box.isEmpty() ? 0 : box.sizes().maxCoeff() / 32768;
}

/// Vertices are compared in the file's frame. Those far from a mesh that has an origin lie as exactly as floats can.
void require_same_triangles(const TriangleMesh& mesh, const TriangleMesh& again) {
    const double allowed = allowed_move(mesh);
    const auto same_place = [&](const Vec3& a, const Vec3& b) {
        for (int i = 0; i < 3; ++i) {
            if (same(a[i], b[i]) && (mesh.origin[i] == again.origin[i] || !std::isfinite(a[i]))) continue;
            const double moved = std::abs(mesh.origin[i] + double{a[i]} - again.origin[i] - double{b[i]});
            const double far = double{std::max(std::abs(a[i]), std::abs(b[i]))} * 0x1p-23;
            if (!(moved <= std::max(allowed, far)) || mesh.origin.isZero(0)) return false;
        }
        return true;
    };
    require(std::ranges::equal(mesh.vertices, again.vertices, same_place), "written vertices are read again");
    require(mesh.faces == again.faces, "written faces are read again");
}

/// The name of each triangle's label; empty where it has none.
std::vector<std::string> names_of_triangles(const MeshFile& file) {
    std::vector<std::string> names(file.mesh.face_count());
    for (std::uint32_t f = 0; file.labels && f < names.size(); ++f) {
        const std::int32_t label = file.labels->label[file.mesh.source_of(f)];
        if (label >= 0) names[f] = file.labels->names[static_cast<std::size_t>(label)];
    }
    return names;
}

/// All faces must have labels.
void require_labels_txt(const FaceLabels& labels) {
    const fs::path path = scratch() / "again_labels.txt";
    write_labels_txt(path, labels);
    const FaceLabels again = read_labels_txt(path, labels.label.size());
    for (std::size_t f = 0; f < labels.label.size(); ++f)
        require(again.names[static_cast<std::size_t>(again.label[f])] ==
                    labels.names[static_cast<std::size_t>(labels.label[f])],
                "written labels are read again");
}

/// Reads `content` with a reader of meshes and checks the mesh, if it is one.
template <typename Read>
bool reads_mesh(const std::string& name, std::string_view content, MemoryBound bound, MeshFile& file, Read&& read) {
    if (!accepts<MeshError>(name, content.size(), bound, [&] { file = read(content, name); })) return false;
    require_promises(file);
    return true;
}

bool reads_off(std::string_view content) {
    MeshFile file;
    if (!reads_mesh("x.off", content, k_usual_bound, file, mesh_io::read_off)) return false;
    const fs::path path = scratch() / "again.off";
    write_off(path, file.mesh);
    require_same_triangles(file.mesh, mesh_io::read_off(read_file(path), "again.off").mesh);
    return true;
}

bool reads_obj(std::string_view content) {
    MeshFile file;
    if (!reads_mesh("x.obj", content, k_usual_bound, file, mesh_io::read_obj)) return false;
    const fs::path path = scratch() / "again.obj";
    write_obj(path, file.mesh);
    require_same_triangles(file.mesh, mesh_io::read_obj(read_file(path), "again.obj").mesh);
    return true;
}

bool reads_ply(std::string_view content) {
    MeshFile file;
    if (!reads_mesh("x.ply", content, k_usual_bound, file, mesh_io::read_ply)) return false;
    const fs::path path = scratch() / "again.ply";
    write_ply(path, file.mesh, file.labels ? &*file.labels : nullptr);
    const MeshFile again = mesh_io::read_ply(read_file(path), "again.ply");
    require_same_triangles(file.mesh, again.mesh);
    require(file.labels.has_value() == again.labels.has_value(), "written labels are read again");
    require(names_of_triangles(file) == names_of_triangles(again), "written labels keep their names");
    if (file.labels && std::ranges::find(file.labels->label, -1) == file.labels->label.end())
        require_labels_txt(*file.labels);
    return true;
}

bool reads_stl(std::string_view content) {
    MeshFile file;
    return reads_mesh("x.stl", content, k_usual_bound, file, mesh_io::read_stl);
}

using LabeledTriangle = std::tuple<std::string, std::array<float, 9>>;

/// In an order that does not depend on the file's.
std::vector<LabeledTriangle> labeled_triangles(const MeshFile& file) {
    const std::vector<std::string> names = names_of_triangles(file);
    std::vector<LabeledTriangle> triangles;
    for (std::uint32_t f = 0; f < names.size(); ++f) {
        std::array<float, 9> place;
        for (std::size_t i = 0; i < place.size(); ++i)
            place[i] = file.mesh.vertices[file.mesh.faces[f][i / 3]][static_cast<Eigen::Index>(i % 3)];
        triangles.emplace_back(names[f], place);
    }
    std::ranges::sort(triangles);
    return triangles;
}

bool reads_gltf(std::string_view content) {
    MeshFile file;
    const auto read = [](std::string_view bytes, const std::string& name) {
        return mesh_io::read_gltf(bytes, name, scratch());
    };
    if (!reads_mesh("x.gltf", content, k_gltf_bound, file, read)) return false;
    const bool writable = !file.mesh.faces.empty() &&
                          std::ranges::all_of(file.mesh.vertices, [](const Vec3& p) { return p.allFinite(); });
    if (!writable) return true;
    const fs::path path = scratch() / "again.glb";
    write_gltf(path, file.mesh,
               file.labels.value_or(FaceLabels{{}, std::vector<std::int32_t>(file.mesh.source_face_count, -1)}));
    require(labeled_triangles(file) == labeled_triangles(read(read_file(path), "again.glb")),
            "written triangles and labels are read again");
    return true;
}

bool reads_draco(std::string_view content) {
    return reads_gltf(glb_of_draco(content));
}

bool reads_meshopt(std::string_view content) {
    return reads_gltf(glb_of_meshopt(content));
}

Animation read_animated_gltf(std::string_view content, const std::string& name) {
    Animation animation = animation_io::read_gltf(content, name, scratch(), {});
    check_animation(animation);
    return animation;
}

bool reads_animation(std::string_view content) {
    Animation animation;
    const auto read = [&] { animation = read_animated_gltf(content, "x.glb"); };
    if (!accepts<MeshError>("x.glb", content.size(), k_animation_bound, read)) return false;
    require_promises(animation);
    if (!animation.has_rig()) return true;  // glTF holds no mesh sequences
    const fs::path path = scratch() / "again.glb";
    write_gltf_animation(path, animation);
    const Animation again = read_animated_gltf(read_file(path), "again.glb");
    require_same_triangles(animation.rest, again.rest);
    require(animation.rig.influence_begin == again.rig.influence_begin, "written influences are read again");
    require(std::ranges::equal(animation.rig.targets, again.rig.targets,
                               [](const MorphTarget& a, const MorphTarget& b) {
                                   return a.vertices == b.vertices && a.offsets == b.offsets;
                               }),
            "written morph targets are read again");
    require(std::ranges::equal(animation.clips, again.clips,
                               [](const Clip& a, const Clip& b) { return a.size() == b.size(); }),
            "written clips are read again");
    return true;
}

/// As many faces as the file could name if all of its numbers were faces.
std::size_t numbers_in(std::string_view content) {
    std::size_t count = 0;
    for (std::string_view word = mesh_io::take_word(content); !word.empty(); word = mesh_io::take_word(content))
        if (mesh_io::parse_integer(word)) ++count;
    return count;
}

bool reads_labels(std::string_view content) {
    const std::size_t faces = numbers_in(content);
    const fs::path path = scratch_file("x_labels.txt", content);
    FaceLabels labels;
    const bool accepted = accepts<DataError>(path.string(), content.size(), k_usual_bound,
                                             [&] { labels = read_labels_txt(path, faces); });
    if (!accepted) return false;
    require(labels.label.size() == faces, "a label per face");
    for (std::int32_t label : labels.label)
        require(label >= 0 && static_cast<std::size_t>(label) < labels.names.size(), "labels have names");
    require_labels_txt(labels);
    return true;
}

bool reads_seg(std::string_view content) {
    const std::size_t faces = numbers_in(content);
    const fs::path path = scratch_file("x.seg", content);
    std::vector<std::int32_t> segments;
    const bool accepted =
        accepts<DataError>(path.string(), content.size(), k_usual_bound, [&] { segments = read_seg(path, faces); });
    if (!accepted) return false;
    require(segments.size() == faces, "a segment per face");
    require(std::ranges::all_of(segments, [](std::int32_t segment) { return segment >= 0; }), "segments from 0 on");
    const auto reads_more = [&] { read_seg(path, faces + 1); };
    require(!accepts<DataError>(path.string(), content.size(), k_usual_bound, reads_more), "one segment too few");
    return true;
}

bool reads_label_json(std::string_view content) {
    return keeps_label_promises(scratch_file("x.json", content), content.size());
}
bool reads_label_npy(std::string_view content) {
    return keeps_label_promises(scratch_file("x.npy", content), content.size());
}
bool reads_label_vtp(std::string_view content) {
    return keeps_label_promises(scratch_file("x.vtp", content), content.size());
}
bool reads_label_list(std::string_view content) {
    return keeps_label_promises(scratch_file("x_list.txt", content), content.size());
}
bool reads_named_seg(std::string_view content) {
    return keeps_label_promises(scratch_file("named.seg", content), content.size());
}
bool reads_obj_groups(std::string_view content) {
    return keeps_label_promises(scratch_file("groups.obj", content), content.size());
}
bool splits_gltf(std::string_view content) {
    return keeps_split_promises(scratch_file(content.starts_with("glTF") ? "x.glb" : "x.gltf", content),
                                content.size());
}

bool same(const Tensor& a, const Tensor& b) {
    return a.type == b.type && a.shape == b.shape && std::ranges::equal(a.bytes, b.bytes);
}

bool same(const std::map<std::string, Tensor>& a, const std::map<std::string, Tensor>& b) {
    return std::ranges::equal(
        a, b, [](const auto& x, const auto& y) { return x.first == y.first && same(x.second, y.second); });
}

bool reads_safetensors(std::string_view content) {
    const fs::path path = scratch_file("x.safetensors", content);
    TensorFile file;
    const bool accepted =
        accepts<ModelError>(path.string(), content.size(), k_usual_bound, [&] { file = read_safetensors(path); });
    if (!accepted) return false;
    const fs::path again = scratch() / "again.safetensors";
    write_safetensors(again, file);
    const TensorFile written = read_safetensors(again);
    require(written.metadata == file.metadata, "written metadata are read again");
    require(same(written.tensors, file.tensors), "written arrays are read again");
    return true;
}

/// Makes a model of another day's features one of today's, so that the corpus outlives them. Whether that was needed
/// and done. What says that it is of today, or not of which day, is not read once more: that is most files, and reading
/// is most of the time.
bool made_for_today(const fs::path& path, std::string_view content, const std::map<std::string, int>& versions) {
    const auto says = [&](const auto& version) {
        return content.find(fmt::format(R"("{}":"{}")", version.first, version.second)) != content.npos;
    };
    const auto tells = [&](const auto& version) { return content.find(version.first) != content.npos; };
    if (std::ranges::all_of(versions, says) || !std::ranges::all_of(versions, tells)) return false;
    try {
        TensorFile file = read_safetensors(path);
        for (const auto& [key, version] : versions) file.metadata[key] = std::to_string(version);
        write_safetensors(path, file);
        return true;
    } catch (const ModelError&) {
        return false;
    }
}

/// Returns how many pixels the header of a JPEG tells; 0 if it is none.
std::size_t jpeg_pixels(std::string_view content) {
    const std::unique_ptr<void, int (*)(tjhandle)> handle(tjInitDecompress(), tjDestroy);
    int width = 0, height = 0, subsampling = 0, colors = 0;
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): TurboJPEG reads bytes
    const auto* bytes = reinterpret_cast<const unsigned char*>(content.data());
    if (tjDecompressHeader3(handle.get(), bytes, static_cast<unsigned long>(content.size()), &width, &height,
                            &subsampling, &colors) != 0)
        return 0;
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
}

bool reads_model(std::string_view content) {
    const fs::path path = scratch_file("x.model", content), again = scratch() / "again.model";
    LabelingModel model;
    const auto load = [&] {
        return accepts<ModelError>(path.string(), content.size(), k_usual_bound, [&] { model = load_model(path); });
    };
    const std::map<std::string, int> today{{"feature_version", k_feature_version}};
    if (!load() && !(made_for_today(path, content, today) && load())) return false;
    save_model(again, model);
    const std::string bytes = read_file(again);
    save_model(again, load_model(again));
    require(read_file(again) == bytes, "equal models give equal bytes");
    return true;
}

bool reads_curvature(std::string_view content) {
    const fs::path path = scratch_file("x.curvature", content), again = scratch() / "again.curvature";
    CurvatureModel model;
    const auto load = [&] { model = load_curvature_model(path); };
    if (!accepts<ModelError>(path.string(), content.size(), k_usual_bound, load)) return false;
    save_curvature_model(again, model);
    require(same(read_safetensors(path).tensors, read_safetensors(again).tensors), "all of the arrays are kept");
    const std::string bytes = read_file(again);
    save_curvature_model(again, load_curvature_model(again));
    require(read_file(again) == bytes, "equal models give equal bytes");
    require_promises(model);
    return true;
}

bool reads_hatching(std::string_view content) {
    const fs::path path = scratch_file("x.hatching", content), again = scratch() / "again.hatching";
    HatchingStyle style;
    const auto load = [&] {
        return accepts<ModelError>(path.string(), content.size(), k_usual_bound,
                                   [&] { style = load_hatching_style(path); });
    };
    const std::map<std::string, int> today{{"feature_version", k_hatching_feature_version}};
    if (!load() && !(made_for_today(path, content, today) && load())) return false;
    require(style.width > 0 && style.height > 0, "a drawing has a size");
    require(style.rules.size() == style.share.size() && !style.rules.empty(), "each segment has a rule and a share");
    require(!style.segments.empty(), "segments are told");
    for (const PropertyModel& property : style.properties)
        require(property.factor > 0 && std::isfinite(property.factor), "properties are positive");
    save_hatching_style(again, style);
    require(is_hatching_style(again), "a written style says that it is one");
    const std::string bytes = read_file(again);
    save_hatching_style(again, load_hatching_style(again));
    require(read_file(again) == bytes, "equal styles give equal bytes");
    return true;
}

bool reads_categories(std::string_view content) {
    const fs::path path = scratch_file("x.categories", content), again = scratch() / "again.categories";
    CategoryModel model;
    const auto load = [&] {
        return accepts<ModelError>(path.string(), content.size(), k_usual_bound,
                                   [&] { model = load_category_model(path); });
    };
    const std::map<std::string, int> today{{"feature_version", k_feature_version},
                                           {"descriptor_version", k_shape_descriptor_version}};
    if (!load() && !(made_for_today(path, content, today) && load())) return false;
    const ShapeDescriptor shape{model.features, std::vector<float>(model.scores.mean.size(), 0.5F)};
    const CategoryPrediction prediction = recognize(model, shape);
    require(prediction.category >= -1 && prediction.category < static_cast<std::int32_t>(model.category_count()),
            "a category or none");
    require(prediction.probability.size() == model.category_count(), "a probability per category");
    require(prediction.confidence >= 0 && prediction.confidence <= 1, "a confidence");
    for (const float p : prediction.probability) require(p >= 0 && p <= 1, "probabilities");
    save_category_model(again, model);
    const std::string bytes = read_file(again);
    save_category_model(again, load_category_model(again));
    require(read_file(again) == bytes, "equal models give equal bytes");
    return true;
}

bool reads_list(std::string_view content) {
    const fs::path path = scratch_file("list.txt", content);
    std::vector<fs::path> meshes;
    const bool accepted =
        accepts<DataError>(path.string(), content.size(), k_usual_bound, [&] { meshes = list_meshes(path); });
    if (!accepted) return false;
    require(!meshes.empty(), "a list holds meshes");
    for (const fs::path& mesh : meshes) require(fs::exists(mesh), "listed meshes exist");
    return true;
}

bool reads_shard(std::string_view content) {
    const fs::path path = scratch_file("x.shard", content), again = scratch() / "again.shard";
    Shard shard;
    if (!accepts<DataError>(path.string(), content.size(), k_usual_bound, [&] { shard = read_shard(path); }))
        return false;
    for (const CatalogShape& shape : shard.shapes) {
        require(is_output_name(shape.name), "results lie in the output folder");
        require(shape.faces >= 0 && shape.bytes >= 0, "counts");
    }
    write_shard(again, shard);
    const std::string bytes = read_file(again);
    require(is_shard(again), "what is written begins as a shard");
    write_shard(again, read_shard(again));
    require(read_file(again) == bytes, "a written shard is read again");
    return true;
}

bool reads_record(std::string_view content) {
    const fs::path path = scratch_file("x.json", content), again = scratch() / "again.json";
    std::optional<ShapeRecord> record;
    accepts<DataError>(path.string(), content.size(), k_usual_bound, [&] { record = read_record(path); });
    if (!record) return false;
    const std::string state = record->state();
    require(state == "done" || state == "failed" || state == "unknown", "a state");
    mesh_files::write_bytes(again, to_json(*record).dump());
    const std::optional<ShapeRecord> back = read_record(again);
    require(back && to_json(*back) == to_json(*record), "a written record is read again");
    return true;
}

/// The text of a style that draws lines just as another does.
std::string text_of(const LineStyle& line) {
    const StrokeThickness& t = line.thickness;
    return fmt::format(R"({{"color": "#{:02x}{:02x}{:02x}", "opacity": {}, "width": {}, "epsilon": {}, "least": {}, )"
                       R"("most": {}, "taper": {}, "texture": "{}"}})",
                       line.color[0], line.color[1], line.color[2], line.opacity, t.width, t.epsilon, t.least, t.most,
                       t.taper, line.texture);
}

bool reads_style(std::string_view content) {
    DrawingStyle style;
    if (!accepts<DataError>("x.json", content.size(), {256 * 1024, 512},
                            [&] { style = parse_style(content, "x.json", scratch()); }))
        return false;
    require(style.fade >= 0 && std::isfinite(style.fade), "a fade that can be drawn");
    for (const LineType type : k_line_types) {
        const LineStyle& line = style.of(type);
        const StrokeThickness& t = line.thickness;
        require(line.opacity >= 0 && line.opacity <= 1, "an opacity");
        require(t.width > 0 && t.epsilon > 0 && t.most > 0 && t.least >= 0 && t.least <= t.most && t.taper >= 0 &&
                    std::isfinite(t.width + t.epsilon + t.most + t.taper),
                "strokes that can be drawn");
        style.thresholds(type);
        const DrawingStyle again = parse_style("{\"default\": " + text_of(line) + "}", "again.json", scratch());
        require(text_of(again.of(type)) == text_of(line), "a written style is read again");
    }
    return true;
}

/// Reads what exemplar-import wrote, damaged by the file that it read.
bool reads_import_output(std::string_view content) {
    std::string_view scene = content;
    mesh_io::take_import_warnings(scene);
    if (!scene.empty() && !scene.starts_with("glTF")) {
        MeshFile file;
        return reads_mesh("x.fbx", content, k_usual_bound, file, mesh_io::mesh_of_import);
    }
    Animation animation;
    const auto read = [&] {
        animation = animation_io::animation_of_import(content, "x.fbx", {});
        check_animation(animation);
    };
    if (!accepts<MeshError>("x.fbx", content.size(), k_animation_bound, read)) return false;
    require_promises(animation);
    return true;
}

std::string_view imported_extension_of(std::string_view content) {
    if (content.starts_with("MM")) return ".3ds";
    if (content.starts_with("PK")) return ".3mf";
    return content.substr(0, 64).find("FBX") != content.npos ? ".fbx" : ".dae";
}

/// Reads a file by exemplar-import, as a mesh and as an animation.
bool reads_import(std::string_view content) {
    const fs::path path = scratch_file("x" + std::string(imported_extension_of(content)), content);
    MeshFile file;
    const auto read_still = [&] { file = read_mesh(path); };
    if (!accepts<MeshError>(path.string(), content.size(), k_import_bound, read_still)) return false;
    require_promises(file);
    Animation animation;
    const auto read_moving = [&] { animation = read_animation(path); };
    if (accepts<MeshError>(path.string(), content.size(), k_import_bound, read_moving)) require_promises(animation);
    return true;
}

/// A picture may have 2^28 pixels of three channels, which a JPEG of one color tells in few bytes; so the bytes that
/// its header tells are allowed, twice, as a turned picture is a copy.
bool reads_picture(std::string_view content) {
    png_text(content, "Exemplar view");
    Image picture;
    constexpr std::size_t k_usual_pixels = std::size_t{1} << 20;
    if (jpeg_pixels(content) > k_usual_pixels) return false;  // takes long, and nothing else
    const MemoryBound bound{8 * 3 * k_usual_pixels, 64};
    if (!accepts<DataError>("x.jpg", content.size(), bound, [&] { picture = decode_jpeg(content, "x.jpg"); }))
        return false;
    require(picture.width > 0 && picture.height > 0 && (picture.channels == 1 || picture.channels == 3), "a picture");
    require(picture.data.size() == static_cast<std::size_t>(picture.width) * static_cast<std::size_t>(picture.height) *
                                       static_cast<std::size_t>(picture.channels),
            "a value for each channel of each pixel");
    return true;
}

/// Returns whether a page decodes to more than a million pixels, which takes long, and nothing else.
bool is_large(const TiffPage& page) {
    constexpr std::size_t k_usual_pixels = std::size_t{1} << 20;
    return std::size_t{page.width} * page.height > k_usual_pixels ||
           page.row_bytes() * std::min(page.block_height, page.height) > 8 * k_usual_pixels;
}

/// A page may have 2^28 pixels of four channels, which few bytes can tell where the paper is blank; so the bytes that
/// its directory tells are allowed, twice, as a turned picture is a copy, and those of a tile.
bool reads_tiff(std::string_view content) {
    constexpr MemoryBound k_directory_bound{64 * 1024, 64};
    const auto size = content.size();
    std::size_t count = 0;
    if (!accepts<DataError>("x.tif", size, k_directory_bound, [&] { count = tiff_page_count(content, "x.tif"); }))
        return false;
    bool any = false;
    for (std::size_t i = 0; i < std::min<std::size_t>(count, 3); ++i) {
        TiffPage page;
        if (!accepts<DataError>("x.tif", size, k_directory_bound, [&] { page = read_tiff_page(content, i, "x.tif"); }))
            continue;
        if (is_large(page)) continue;
        const MemoryBound bound{std::size_t{24} << 20, 64};
        Image image;
        if (!accepts<DataError>("x.tif", size, bound, [&] { image = decode_tiff(page, "x.tif"); })) continue;
        const bool turned = page.orientation >= 5;
        require(image.width == static_cast<int>(turned ? page.height : page.width) &&
                    image.height == static_cast<int>(turned ? page.width : page.height),
                "a picture of the page's size");
        require(image.channels == 1 || image.channels == 3 || image.channels == 4, "gray, RGB or RGBA");
        any = true;
    }
    return any;
}

/// Curves are flattened to up to 64 pieces, which few bytes can tell.
bool reads_svg(std::string_view content) {
    constexpr MemoryBound k_svg_bound{256 * 1024, 1024};
    SvgPicture picture;
    if (!accepts<DataError>("x.svg", content.size(), k_svg_bound, [&] { picture = read_svg(content, "x.svg"); }))
        return false;
    require(picture.width > 0 && picture.height > 0 && !picture.strokes.empty(), "a page with strokes");
    for (const SvgStroke& stroke : picture.strokes) {
        require(stroke.points.size() >= 2 && stroke.width > 0 && stroke.opacity > 0 && stroke.opacity <= 1, "a stroke");
        for (const Eigen::Vector2d& point : stroke.points) require(point.allFinite(), "finite points");
        require(stroke.group < static_cast<int>(picture.groups.size()), "a group that is there");
    }
    for (int i = 0; const SvgGroup& group : picture.groups) require(group.outer < i++, "groups around groups");
    return true;
}

constexpr std::array<Reader, 31> k_readers{{{"off", reads_off},
                                            {"obj", reads_obj},
                                            {"ply", reads_ply},
                                            {"stl", reads_stl},
                                            {"gltf", reads_gltf},
                                            {"draco", reads_draco},
                                            {"meshopt", reads_meshopt},
                                            {"animation", reads_animation},
                                            {"labels", reads_labels},
                                            {"seg", reads_seg},
                                            {"label_json", reads_label_json},
                                            {"label_npy", reads_label_npy},
                                            {"label_vtp", reads_label_vtp},
                                            {"label_list", reads_label_list},
                                            {"named_seg", reads_named_seg},
                                            {"obj_groups", reads_obj_groups},
                                            {"gltf_split", splits_gltf},
                                            {"safetensors", reads_safetensors},
                                            {"model", reads_model},
                                            {"curvature", reads_curvature},
                                            {"hatching", reads_hatching},
                                            {"categories", reads_categories},
                                            {"list", reads_list},
                                            {"shard", reads_shard},
                                            {"record", reads_record},
                                            {"style", reads_style},
                                            {"picture", reads_picture},
                                            {"tiff", reads_tiff},
                                            {"svg", reads_svg},
                                            {"import_output", reads_import_output},
                                            {"import", reads_import, true}}};

}  // namespace

std::span<const Reader> readers() {
    return k_readers;
}

}  // namespace exemplar::fuzz
