#include "apps/viewer/painting/folder_job.h"

#include <algorithm>
#include <utility>

#include "host/core/cancel.h"
#include "host/core/errors.h"
#include "host/core/interrupt.h"
#include "host/core/progress.h"
#include "host/data/corpus.h"
#include "host/imaging/raster.h"
#include "host/labeling/features/fast_context.h"
#include "host/labeling/inference/mesh_labeling.h"
#include "host/labeling/painting/folder_learning.h"
#include "host/labeling/painting/suggestions.h"
#include "host/mesh/io/io.h"

namespace exemplar {
namespace {

/// The operations of labeling on the host, as the device draws the window.
struct HostBackend {
    CpuStumpScorer scorer;
    FastContextHistograms context;
    LabelingBackend operations() { return {scorer, context}; }
};

/// Returns the direction from which a thumbnail is seen: obliquely, or on the side that is least certain.
Vec3 thumbnail_direction(const TriangleMesh& mesh, std::span<const float> confidence) {
    Vec3 oblique = Vec3(0.6F, 0.5F, 1).normalized();
    if (confidence.empty()) return oblique;
    const std::vector<Vec3> normal = face_normals(mesh);
    const std::vector<float> area = face_areas(mesh);
    Vec3d toward = Vec3d::Zero();
    double total = 0;
    for (std::size_t f = 0; f < normal.size(); ++f) {
        const double doubt = static_cast<double>(area[f]) * static_cast<double>(1 - confidence[f]);
        toward += doubt * normal[f].cast<double>();
        total += doubt;
    }
    return (oblique + 2 * (total > 0 ? Vec3((toward / total).cast<float>()) : Vec3(Vec3::Zero()))).normalized();
}

/// Draws a mesh in the colors of its labels, per face of the file.
Image draw_thumbnail(const TriangleMesh& mesh, std::span<const std::int32_t> label,
                     std::span<const float> triangle_confidence, std::span<const PaletteEntry> palette) {
    constexpr Color k_clay{214, 212, 206};
    std::vector<Color> colors;
    colors.reserve(mesh.face_count());
    for (std::uint32_t t = 0; t < mesh.face_count(); ++t) {
        const std::int32_t own = label.empty() ? -1 : label[mesh.source_of(t)];
        colors.push_back(own < 0 ? k_clay : palette[static_cast<std::size_t>(own)].color);
    }
    constexpr float k_aspect = static_cast<float>(FolderJob::k_thumbnail_width) / FolderJob::k_thumbnail_height;
    const Camera camera = fit_camera(mesh, thumbnail_direction(mesh, triangle_confidence), k_aspect);
    return render_mesh(mesh, colors, camera, FolderJob::k_thumbnail_width, FolderJob::k_thumbnail_height,
                       {.background = {250, 250, 248}});
}

/// Returns the verified labels of a shape, as indices into the palette; empty if they cannot be read.
std::vector<std::int32_t> verified_labels(const FolderShape& shape, std::span<const PaletteEntry> palette,
                                          std::size_t faces) {
    if (!shape.verified) return {};
    const FaceLabels labels = read_labels_txt(labels_path(shape.path), faces);
    std::vector<std::int32_t> result;
    result.reserve(labels.label.size());
    for (const std::int32_t label : labels.label) {
        const auto place =
            std::ranges::find(palette, labels.names[static_cast<std::size_t>(label)], &PaletteEntry::name);
        result.push_back(place == palette.end() ? -1 : static_cast<std::int32_t>(place - palette.begin()));
    }
    return result;
}

std::size_t file_faces(const TriangleMesh& mesh) {
    return mesh.source_face_count > 0 ? mesh.source_face_count : mesh.face_count();
}

}  // namespace

FolderJob::FolderJob(FolderWork work) : work_(std::move(work)) {
    Progress::set_listener([this](const ProgressState& state) {
        if (canceled()) throw Interrupted();
        set_status(state.what.c_str(), state.done, state.total);
    });
    start([this] { return run(); });
}

FolderJob::~FolderJob() {
    end();
    Progress::set_listener({});
}

FolderJob::Status FolderJob::status() const {
    const std::lock_guard lock(mutex_);
    return status_;
}

void FolderJob::set_status(const char* what, std::size_t done, std::size_t total) {
    const std::lock_guard lock(mutex_);
    status_ = {what, static_cast<float>(done) / static_cast<float>(std::max<std::size_t>(total, 1))};
}

std::vector<ShapeResult> FolderJob::take_results() {
    const std::lock_guard lock(mutex_);
    return std::exchange(results_, {});
}

void FolderJob::post(ShapeResult result) {
    const std::lock_guard lock(mutex_);
    results_.push_back(std::move(result));
}

std::vector<std::string> FolderJob::palette_names() const {
    std::vector<std::string> names;
    names.reserve(work_.palette.size());
    for (const PaletteEntry& entry : work_.palette) names.push_back(entry.name);
    return names;
}

std::shared_ptr<const LabelingModel> FolderJob::run() {
    lower_thread_priority();
    std::shared_ptr<const LabelingModel> model;
    run_cancelable(
        canceled_flag(),
        [&] {
            if (work_.draws_thumbnails) draw_thumbnails();
            model = train();
            if (model) suggest(*model);
            describe_shapes(model != nullptr);
        },
        LoopThreads::this_thread);
    return model;
}

void FolderJob::draw_thumbnails() {
    for (std::size_t s = 0; s < work_.shapes.size(); ++s) {
        check_interrupt();
        set_status("drawing thumbnails", s, work_.shapes.size());
        ShapeResult result{.shape = s};
        try {
            const MeshFile file = read_mesh(work_.shapes[s].path);
            result.thumbnail = draw_thumbnail(
                file.mesh, verified_labels(work_.shapes[s], work_.palette, file_faces(file.mesh)), {}, work_.palette);
        } catch (const Interrupted&) {
            throw;
        } catch (const Error& error) {
            result.error = error.what();
        }
        post(std::move(result));
    }
}

// Suggestions have described the shapes that are not verified.
void FolderJob::describe_shapes(bool only_verified) {
    for (std::size_t s = 0; s < work_.shapes.size(); ++s) {
        check_interrupt();
        set_status("measuring shapes", s, work_.shapes.size());
        if (work_.described[s] || (only_verified && !work_.shapes[s].verified)) continue;
        try {
            const TriangleMesh mesh = read_mesh(work_.shapes[s].path).mesh;
            const WorkingFeatures features = working_features(suggestion_training().features, mesh, work_.cache);
            post({.shape = s, .descriptor = compute_shape_descriptor(features.features)});
        } catch (const Interrupted&) {
            throw;
        } catch (const Error& error) {
            post({.shape = s, .error = error.what()});
        }
    }
}

std::shared_ptr<const LabelingModel> FolderJob::train() {
    set_status("reading verified shapes", 0, 1);
    HostBackend backend;
    std::shared_ptr<const LabelingModel> model = learn_from_verified(work_.shapes, work_.cache, backend.operations());
    if (model && !work_.model_file.empty()) save_model(work_.model_file, *model);
    return model;
}

void FolderJob::suggest(const LabelingModel& model) {
    HostBackend backend;
    const std::vector<std::string> names = palette_names();
    for (std::size_t s = 0; s < work_.shapes.size(); ++s) {
        check_interrupt();
        set_status("labeling the other shapes", s, work_.shapes.size());
        if (work_.shapes[s].verified) continue;
        ShapeResult result{.shape = s};
        try {
            SuggestedShape shape = suggest_shape(model, work_.shapes[s].path, names, work_.cache, backend.operations());
            result.thumbnail = draw_thumbnail(shape.mesh, shape.label, shape.confidence, work_.palette);
            result.uncertainty = shape.uncertainty;
            result.descriptor = std::move(shape.descriptor);
            result.label = std::move(shape.label);
        } catch (const Interrupted&) {
            throw;
        } catch (const Error& error) {
            result.error = error.what();
        }
        post(std::move(result));
    }
}

}  // namespace exemplar
