#include "host/labeling/evaluation/evaluation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host/core/errors.h"
#include "host/core/random.h"
#include "host/labeling/inference/crf.h"
#include "host/learn/metrics.h"
#include "host/mesh/io/io.h"
#include "host/mesh/topology.h"

namespace exemplar {
namespace {

Split leave_one_out(std::size_t count, std::size_t tested) {
    Split split;
    for (std::size_t i = 0; i < count; ++i) (i == tested ? split.test : split.train).push_back(i);
    return split;
}

Split random_split(std::size_t count, std::size_t train_count, Random random) {
    std::vector<std::size_t> order(count);
    std::iota(order.begin(), order.end(), std::size_t{0});
    random.shuffle(order);
    const auto middle = order.begin() + static_cast<std::ptrdiff_t>(train_count);
    Split split{{order.begin(), middle}, {middle, order.end()}};
    std::sort(split.train.begin(), split.train.end());
    std::sort(split.test.begin(), split.test.end());
    return split;
}

}  // namespace

std::vector<Split> make_splits(std::size_t count, std::size_t train_count, std::size_t splits, std::uint64_t seed) {
    if (train_count == 0 || train_count >= count)
        throw UsageError(
            fmt::format("{} meshes cannot be split into {} for training and some to test", count, train_count));
    std::vector<Split> result;
    for (std::size_t k = 0; k < splits; ++k)
        result.push_back(train_count + 1 == count ? leave_one_out(count, k % count)
                                                  : random_split(count, train_count, Random(seed).fork(k)));
    return result;
}

MeshScore score_labeling(std::span<const float> face_area, std::span<const std::int32_t> truth,
                         std::span<const std::int32_t> predicted, std::size_t classes) {
    MeshScore score;
    const ConfusionMatrix confusion = confusion_matrix(truth, predicted, face_area, classes);
    score.recognition_rate = recognition_rate(confusion);
    score.segment_weighted_accuracy = segment_weighted_accuracy(confusion);
    const double total = std::max(std::accumulate(confusion.area.begin(), confusion.area.end(), 0.0), 1e-30);
    for (std::size_t t = 0; t < classes; ++t)
        for (std::size_t p = 0; p < classes; ++p) score.confusion.push_back(confusion.at(t, p) / total);
    return score;
}

std::vector<std::int32_t> most_probable_labels(std::span<const float> probabilities, std::size_t classes) {
    std::vector<std::int32_t> labels;
    for (std::size_t begin = 0; begin < probabilities.size(); begin += classes) {
        const auto face = probabilities.subspan(begin, classes);
        labels.push_back(static_cast<std::int32_t>(std::ranges::max_element(face) - face.begin()));
    }
    return labels;
}

std::vector<float> relative_entropy(std::span<const float> probabilities, std::size_t classes) {
    std::vector<float> entropy;
    entropy.reserve(probabilities.size() / classes);
    for (std::size_t begin = 0; begin < probabilities.size(); begin += classes) {
        double sum = 0;
        for (const float p : probabilities.subspan(begin, classes))
            if (p > 0) sum -= double{p} * std::log(double{p});
        entropy.push_back(classes > 1 ? static_cast<float>(std::clamp(sum / std::log(classes), 0.0, 1.0)) : 0);
    }
    return entropy;
}

SegmentationErrors score_segmentation(const TriangleMesh& mesh, std::span<const std::int32_t> predicted,
                                      std::span<const std::vector<std::int32_t>> human_segmentations) {
    if (human_segmentations.empty()) return {};
    std::vector<std::array<std::uint32_t, 2>> neighbors;
    for (const Edge& edge : build_topology(mesh).edges)
        if (!edge.is_boundary()) neighbors.push_back(edge.face);
    const LabelComponents pieces = label_components(neighbors, face_areas(mesh), predicted);
    const std::vector<std::int32_t> segments(pieces.of_face.begin(), pieces.of_face.end());
    return SegmentationMetrics(mesh).mean_errors(segments, human_segmentations);
}

std::vector<std::filesystem::path> human_segmentation_files(const std::filesystem::path& folder,
                                                            const std::string& name) {
    std::vector<std::filesystem::path> paths;
    if (folder.empty() || !std::filesystem::is_directory(folder / name)) return {};
    for (const auto& entry : std::filesystem::directory_iterator(folder / name))
        if (entry.path().extension() == ".seg") paths.push_back(entry.path());
    std::sort(paths.begin(), paths.end());
    return paths;
}

std::vector<std::vector<std::int32_t>> read_human_segmentations(const std::filesystem::path& folder,
                                                                const std::string& name, std::size_t faces) {
    const std::vector<std::filesystem::path> paths = human_segmentation_files(folder, name);
    std::vector<std::vector<std::int32_t>> segmentations;
    segmentations.reserve(paths.size());
    for (const auto& path : paths) segmentations.push_back(read_seg(path, faces));
    return segmentations;
}

}  // namespace exemplar
