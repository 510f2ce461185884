// Features and labels of the faces of meshes, and context and cuts of them by given probabilities.
//   compare_faces features CACHE OUT MESH...       writes OUT/NAME.npy, faces x features
//   compare_faces context CACHE CLASSES IN OUT MESH...
//   compare_faces cut CACHE MODEL IN OUT MESH...
// CACHE remembers features between calls, and shares them with 'exemplar label --cache'. IN and OUT are safetensors
// files. For context, IN has probabilities NAME (faces x CLASSES) and OUT gets the contextual label histograms NAME
// (faces x columns, in the order of ContextHistograms). For cut, IN has probabilities NAME/LEARNER (faces x labels of
// the model) and OUT gets labels NAME/LEARNER (I32) after the graph cut of the model, which brings its boundary
// classifier and its weights.

#include <fmt/format.h>

#include <exception>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host/core/errors.h"
#include "host/data/npy.h"
#include "host/data/safetensors.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/inference/model.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

void write_features(const fs::path& cache, const fs::path& out, std::span<char*> meshes) {
    for (const fs::path mesh : meshes) {
        const WorkingFeatures working = working_features({}, read_mesh(mesh).mesh, cache);
        write_npy(out / mesh.stem().concat(".npy"), working.features.unary, working.face_of);
    }
}

/// Probabilities of the faces of the working mesh: each from the last of the faces that it stands for.
std::vector<float> of_working_faces(const std::vector<float>& probabilities, const WorkingFeatures& working,
                                    std::size_t classes) {
    std::vector<float> result(working.features.unary.rows * classes, 1 / static_cast<float>(classes));
    for (std::size_t f = 0; f < working.face_of.size(); ++f)
        for (std::size_t c = 0; c < classes; ++c)
            result[working.face_of[f] * classes + c] = probabilities[f * classes + c];
    return result;
}

/// Values of the faces of a mesh, faces x columns, from those of its working mesh.
std::vector<float> of_original_faces(const FeatureMatrix& matrix, const WorkingFeatures& working) {
    std::vector<float> result;
    result.reserve(working.face_of.size() * matrix.cols());
    for (const std::uint32_t face : working.face_of)
        for (std::size_t k = 0; k < matrix.cols(); ++k) result.push_back(matrix.column(k)[face]);
    return result;
}

void write_context(const fs::path& cache, std::size_t classes, const fs::path& in, const fs::path& out,
                   std::span<char*> meshes) {
    const TensorFile file = read_safetensors(in);
    const std::vector<std::string> names = context_names(std::vector<std::string>(classes));
    CpuContextHistograms context;
    TensorFile result;
    for (const fs::path mesh : meshes) {
        const WorkingFeatures working = working_features({}, read_mesh(mesh).mesh, cache);
        const std::string name = mesh.stem().string();
        const auto given = file.get<float>(name, {working.face_of.size(), classes});
        FeatureMatrix histograms{working.features.unary.rows, {}, {}};
        context.accumulate(working.features.context, of_working_faces(given, working, classes), classes,
                           context_columns(histograms, 0, names));
        result.add(name, {working.face_of.size(), names.size()}, of_original_faces(histograms, working));
    }
    write_safetensors(out, result);
}

void cut(const fs::path& cache, const fs::path& model_path, const fs::path& in, const fs::path& out,
         std::span<char*> meshes) {
    const LabelingModel model = load_model(model_path);
    const TensorFile file = read_safetensors(in);
    CpuStumpScorer scorer;
    CpuContextHistograms context;
    TensorFile result;
    for (const fs::path mesh : meshes) {
        WorkingFeatures working = working_features(model.feature_options, read_mesh(mesh).mesh, cache);
        MeshFeatures* const features = &working.features;
        const std::vector<float> boundary =
            score_faces(model, std::span(&features, 1), {scorer, context}).front().boundary;
        const std::string prefix = mesh.stem().string() + "/";
        for (const auto& [name, tensor] : file.tensors) {
            if (!name.starts_with(prefix)) continue;
            const auto given = file.get<float>(name, {working.face_of.size(), model.class_count()});
            FaceScores scores;
            scores.probabilities = of_working_faces(given, working, model.class_count());
            scores.boundary = boundary;
            result.add(name, {working.face_of.size()}, finish_labeling(model, working, std::move(scores)).label);
        }
    }
    write_safetensors(out, result);
}

void run(std::span<char*> arguments) {
    const std::string task = arguments.size() > 1 ? arguments[1] : "";
    if (task == "features" && arguments.size() > 4) {
        write_features(arguments[2], arguments[3], arguments.subspan(4));
    } else if (task == "context" && arguments.size() > 6) {
        write_context(arguments[2], std::stoul(arguments[3]), arguments[4], arguments[5], arguments.subspan(6));
    } else if (task == "cut" && arguments.size() > 6) {
        cut(arguments[2], arguments[3], arguments[4], arguments[5], arguments.subspan(6));
    } else {
        throw UsageError("see the head of faces.cpp for the arguments");
    }
}

}  // namespace
}  // namespace exemplar

int main(int count, char** arguments) {
    try {
        exemplar::run({arguments, static_cast<std::size_t>(count)});
        return 0;
    } catch (const std::exception& error) {
        fmt::print(stderr, "error: {}\n", error.what());
        return 1;
    }
}
