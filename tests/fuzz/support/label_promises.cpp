#include "tests/fuzz/support/label_promises.h"

#include "host/core/errors.h"
#include "host/mesh/gltf/gltf_split.h"
#include "host/mesh/label_files/label_files.h"
#include "tests/fuzz/support/promises.h"
#include "tests/support/mesh_files.h"

namespace exemplar::fuzz {
namespace {

constexpr MemoryBound k_label_bound{256 * 1024, 256};

const MeshFile& labeled_strip() {
    static const MeshFile file = mesh_files::read_as(
        "strip.off", "OFF\n7 3 0\n0 0 0\n1 0 0\n2 0 0\n2 1 0\n1 1 0\n0 1 0\n3 0.5 0\n4 0 1 4 5\n4 1 2 3 4\n3 2 6 3\n");
    return file;
}

}  // namespace

bool keeps_label_promises(const std::filesystem::path& path, std::size_t size) {
    const MeshFile& file = labeled_strip();
    FaceLabels labels;
    if (!accepts<DataError>(path.string(), size, k_label_bound, [&] { labels = read_face_labels(path, file.mesh); }))
        return false;
    require(labels.label.size() == 3, "a label per face");
    for (const std::int32_t label : labels.label)
        require(label >= -1 && label < static_cast<std::int32_t>(labels.names.size()), "labels have names");
    const std::filesystem::path stem = path.parent_path() / "again";
    for (const char* form : {"json", "vtp"}) {
        const FaceLabels again = read_face_labels(write_label_file(stem, form, file, labels), file.mesh);
        for (std::size_t f = 0; f < 3; ++f) {
            require((again.label[f] < 0) == (labels.label[f] < 0), "unlabeled faces stay so");
            if (labels.label[f] >= 0)
                require(again.names[static_cast<std::size_t>(again.label[f])] ==
                            labels.names[static_cast<std::size_t>(labels.label[f])],
                        "written labels are read again");
        }
    }
    write_label_file(stem, "vertices-json", file, labels);
    return true;
}

bool keeps_split_promises(const std::filesystem::path& path, std::size_t size) {
    constexpr MemoryBound k_split_bound{std::size_t{1} << 30, 4096};
    std::size_t triangles = 0;
    SplitGltf split;
    const auto read = [&] {
        triangles = read_mesh(path).mesh.face_count();
        std::vector<std::uint32_t> part(triangles);
        for (std::size_t f = 0; f < part.size(); ++f) part[f] = static_cast<std::uint32_t>(f % 3);
        const std::vector<std::string> names{"a", "b", "c"};
        split = split_gltf(path, part, names);
    };
    if (!accepts<MeshError>(path.string(), size, k_split_bound, read)) return false;
    const std::filesystem::path again = path.parent_path() / "again.glb";
    mesh_files::write_bytes(again, split.bytes);
    require(read_mesh(again).mesh.face_count() == triangles, "a divided file has the same triangles");
    return true;
}

}  // namespace exemplar::fuzz
