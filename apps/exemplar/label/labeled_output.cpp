#include "apps/exemplar/label/labeled_output.h"

#include <numeric>

#include "host/data/corpus.h"

namespace exemplar {

LabeledOutput make_labeled_output(const TriangleMesh& mesh, const LabelingModel& model, const FaceLabeling& labeling) {
    LabeledOutput output;
    output.labels.names = model.label_names;
    output.labels.label = to_source_faces(mesh, labeling.label);
    output.confidence.assign(output.labels.label.size(), 0);
    const std::vector<float> area = face_areas(mesh);
    std::vector<float> total(output.confidence.size(), 0);
    for (std::uint32_t f = 0; f < mesh.face_count(); ++f) {
        const float weight = area[f] + 1e-30F;  // a polygon of no area still has a confidence
        output.confidence[mesh.source_of(f)] += weight * labeling.confidence[f];
        total[mesh.source_of(f)] += weight;
    }
    for (std::size_t s = 0; s < total.size(); ++s)
        if (total[s] > 0) output.confidence[s] /= total[s];
    return output;
}

void write_labeled_files(const std::filesystem::path& stem, const MeshFile& file, const LabeledOutput& output,
                         bool gltf) {
    const TriangleMesh& mesh = file.mesh;
    write_labels_txt(stem.string() + "_labels.txt", output.labels);
    write_seg(stem.string() + ".seg", mesh, output.labels);
    write_ply(stem.string() + ".ply", mesh, &output.labels, output.confidence, &file.polygons);
    if (gltf) write_gltf(stem.string() + ".glb", mesh, output.labels);
}

std::vector<Color> triangle_colors(const LabelingModel& model, const FaceLabeling& labeling) {
    std::vector<Color> colors;
    for (const std::int32_t label : labeling.label) colors.push_back(model.label_colors[label]);
    return colors;
}

nlohmann::json describe_output(const TriangleMesh& mesh, const LabelingModel& model, const FaceLabeling& labeling) {
    const std::vector<float> area = face_areas(mesh);
    const double total = std::max(std::accumulate(area.begin(), area.end(), 0.0), 1e-30);
    std::vector<double> share(model.class_count(), 0), confidence(model.class_count(), 0);
    std::vector<std::size_t> faces(model.class_count(), 0);
    double mean_confidence = 0;
    for (std::size_t f = 0; f < area.size(); ++f) {
        const std::int32_t label = labeling.label[f];
        share[label] += area[f] / total;
        confidence[label] += area[f] / total * labeling.confidence[f];
        mean_confidence += area[f] / total * labeling.confidence[f];
        ++faces[label];
    }
    nlohmann::json labels = nlohmann::json::array();
    for (std::size_t c = 0; c < model.class_count(); ++c) {
        if (faces[c] == 0) continue;
        labels.push_back({{"label", model.label_names[c]},
                          {"area_share", share[c]},
                          {"triangles", faces[c]},
                          {"confidence", share[c] > 0 ? confidence[c] / share[c] : 0.0}});
    }
    return {{"triangles", mesh.face_count()},
            {"confidence", mean_confidence},
            {"turned", labeling.turned},
            {"labels", labels}};
}

}  // namespace exemplar
