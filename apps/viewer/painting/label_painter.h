#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/viewer/painting/brush.h"
#include "apps/viewer/painting/completion_worker.h"
#include "host/labeling/painting/painted_labels.h"
#include "host/mesh/mesh.h"
#include "host/mesh/topology.h"

namespace exemplar {

enum class PaintTool { brush, eraser, lasso, fill };

/// How the mouse paints.
struct PaintSettings {
    PaintTool tool = PaintTool::brush;
    std::int32_t label = 0;   ///< an index into the palette
    float radius = 12;        ///< of the brush, in pixels
    bool through = false;     ///< hidden faces are painted as well
    bool completes = true;    ///< the labels of the whole mesh are completed from what is painted
    bool confidence = false;  ///< uncertain places are shown gray
};

/// A place on the surface, and the direction from which it is seen.
struct SurfacePlace {
    Vec3 point, normal;
};

/// One mesh that a person paints labels on. What is painted belongs to the faces of the file (polygons included);
/// pictures show the drawable mesh. Completion runs in the background; poll() collects it.
class LabelPainter {
  public:
    /// `file_mesh`: as read from the file. `shown`: made of it for drawing (see drawable_mesh). `cache`: of features.
    LabelPainter(const TriangleMesh& file_mesh, TriangleMesh shown, std::filesystem::path cache);

    const PaintedLabels& painted() const { return painted_; }
    std::size_t face_count() const { return painted_.labels().size(); }
    /// Starts with labels that are known already, of the file's faces; this is no step of undo.
    void start_with(std::span<const std::int32_t> labels);
    /// Sets the number of labels of the palette.
    void set_label_count(std::size_t count);
    /// Lets a model suggest labels, in the background. `palette`: the names of the labels.
    void suggest_by(std::shared_ptr<const LabelingModel> model, std::vector<std::string> palette) {
        worker_.suggest_by(std::move(model), std::move(palette));
    }

    /// Forgets what the model suggested, so that the shape is painted anew. Returns whether there was a suggestion.
    bool discard_suggestion();

    // A stroke, lasso or fill is one step of undo.
    void begin_stroke() { painted_.begin_step(); }
    /// Paints or erases along a part of the way of the mouse.
    void brush(const FacePicture& picture, const PaintSettings& settings, const Vec2& from, const Vec2& to);
    void lasso(const FacePicture& picture, const PaintSettings& settings, std::span<const Vec2> polygon);
    /// Paints the piece around a face of the shown mesh: the faces connected to it that show the same label.
    void fill(std::uint32_t shown_face, std::int32_t label);
    /// Paints each unpainted face whose mirror image is painted. Returns the number of faces, 0 if the mesh has no
    /// plane of symmetry.
    std::size_t mirror();
    /// Makes what is shown painted: all faces hold their labels.
    void keep_shown();
    bool undo();
    bool redo();

    /// Asks for a completion if something has changed, and collects the last one. Returns whether the shown labels
    /// changed.
    bool poll(const PaintSettings& settings);
    /// Whether the shown labels will still change.
    bool busy() const { return worker_.busy() || asked_version_ != painted_.version(); }
    bool has_features() const { return worker_.has_features(); }
    std::string take_error() { return worker_.take_error(); }
    /// Seconds from the last request of a completion to its result; 0 before the first.
    double completion_seconds() const { return completion_seconds_; }

    /// Per face of the file: the shown label, or -1.
    std::span<const std::int32_t> labels() const { return label_; }
    std::span<const float> confidence() const { return confidence_; }
    /// Number of faces of the file that show no label.
    std::size_t unlabeled_count() const;
    /// Changes when the shown labels do.
    std::uint64_t version() const { return version_; }
    /// Returns a color per face of the shown mesh: that of the label, paler where it is not painted.
    std::vector<Color> face_colors(std::span<const PaletteEntry> palette, const PaintSettings& settings) const;

    /// Returns the next place, of those not yet visited, where the labels are least certain; nullopt if all is certain.
    std::optional<SurfacePlace> next_uncertain_place();

    const TriangleMesh& shown_mesh() const { return shown_; }

  private:
    void paint_shown(std::span<const std::uint32_t> shown_faces, std::int32_t label);
    void show_painted();
    void show_suggestion(const CompletedLabels& triangles);
    void show_completion(const CompletionWorker::Answer& answer);
    void ask(const PaintSettings& settings);
    std::vector<std::int32_t> painted_triangles() const;

    TriangleMesh file_, shown_;
    Topology topology_;  ///< of the shown mesh
    PaintedLabels painted_;
    std::size_t label_count_ = 0;
    std::vector<std::int32_t> label_;      ///< per face of the file
    std::vector<float> confidence_;        ///< per face of the file
    std::vector<std::int32_t> suggested_;  ///< per face of the file; empty without a model
    std::vector<float> suggested_confidence_;
    std::vector<bool> visited_;  ///< per face of the shown mesh
    bool completes_ = true;
    std::uint64_t asked_version_ = 0, version_ = 1;
    std::size_t asked_labels_ = 0;
    double completion_seconds_ = 0;
    CompletionWorker worker_;
};

}  // namespace exemplar
