#include "host/labeling/category/descriptor_cache.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "host/core/json_text.h"
#include "host/data/result_cache.h"
#include "host/labeling/features/feature_cache.h"
#include "host/labeling/inference/mesh_labeling.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

fs::path descriptor_path(const TriangleMesh& mesh, const FeatureOptions& options, const fs::path& folder) {
    const fs::path features = feature_entry_name(mesh, options);
    return folder / fmt::format("{}-shape{}.safetensors", features.stem().string(), k_shape_descriptor_version);
}

ShapeDescriptor descriptor_from_file(const TensorFile& file) {
    ShapeDescriptor shape;
    shape.features = parse_json(file.meta("features")).get<std::vector<std::string>>();
    shape.values = file.get<float>("values", {k_shape_statistics, shape.features.size()});
    return shape;
}

TensorFile descriptor_to_file(const ShapeDescriptor& shape) {
    TensorFile file;
    file.metadata["features"] = json_text(Json(shape.features));
    file.add("values", {k_shape_statistics, shape.features.size()}, shape.values);
    return file;
}

}  // namespace

ShapeDescriptor cached_shape_descriptor(const TriangleMesh& mesh, const FeatureOptions& options,
                                        const fs::path& folder) {
    const TriangleMesh working = working_mesh(mesh).mesh;
    if (folder.empty()) return compute_shape_descriptor(compute_features(working, options));
    const fs::path path = descriptor_path(working, options, folder);
    ShapeDescriptor shape;
    if (read_cache_entry(path, k_feature_version, [&](const TensorFile& file) { shape = descriptor_from_file(file); }))
        return shape;
    const std::optional<MeshFeatures> known = find_cached_features(working, options, folder);
    shape = compute_shape_descriptor(known ? *known : compute_features(working, options));
    write_cache_entry(path, k_feature_version, descriptor_to_file(shape));
    return shape;
}

}  // namespace exemplar
