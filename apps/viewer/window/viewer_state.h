#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "apps/viewer/controls/frame_times.h"
#include "apps/viewer/controls/orbit_camera.h"
#include "apps/viewer/controls/playback.h"
#include "apps/viewer/controls/pose_controls.h"
#include "apps/viewer/controls/shortcuts.h"
#include "apps/viewer/controls/training_job.h"
#include "apps/viewer/scene/document.h"
#include "apps/viewer/scene/hatching_job.h"
#include "apps/viewer/window/messages.h"
#include "apps/viewer/scene/surface_scene.h"
#include "apps/viewer/scene/view_settings.h"
#include "host/curvature/model/model.h"

namespace exemplar {

/// All that a viewer knows on the host, with or without a window; what is on the device follows from it.
class ViewerState {
  public:
    /// Opens a mesh, animation, model or style of hatching (.safetensors), style (.json), labels (_labels.txt, .seg),
    /// whatever it is. Throws an Error; what was open stays then.
    void open(const std::filesystem::path& path, ViewSize view);
    /// A model, whatever its name. Throws ModelError if it is none, or not of the document.
    void open_model(const std::filesystem::path& path);
    /// A style of hatching. Throws ModelError if it is none.
    void open_hatching(const std::filesystem::path& path);
    void close();
    void set_clip(std::size_t clip);
    void set_model(std::shared_ptr<const CurvatureModel> model, std::string name);
    /// Shows all that the current clip reaches.
    void fit(ViewSize view);
    /// Does what keys ask for, but for what concerns a window, which it returns false for.
    bool perform(Action action, ViewSize view);

    /// Starts to learn curvature from the frames of the document; from random expressions if it has none. Throws
    /// UsageError if there is too little to learn from.
    void start_training();
    /// Takes what training has learned, when it is done.
    void collect_training();

    /// Starts to draw a hatched still of that size, on a device of that name, for those files; nothing while another is
    /// being drawn. Throws UsageError if no style of hatching is open.
    void start_hatching(ViewSize size, const std::string& device, StillNames names);
    /// Says what was drawn, when it is done.
    void collect_hatching();

    bool has_document() const { return document_ != nullptr; }
    const Document& document() const { return *document_; }
    /// Another number means another document, or model.
    std::uint64_t document_version() const { return document_version_; }
    std::uint64_t model_version() const { return model_version_; }
    std::size_t clip() const { return clip_; }
    std::shared_ptr<const CurvatureModel> model() const { return model_; }
    const std::string& model_name() const { return model_name_; }
    std::shared_ptr<const HatchingStyle> hatching() const { return hatching_; }
    const std::string& hatching_name() const { return hatching_name_; }
    /// With what sliders change of it.
    Moment moment() const;

    /// Whether learned and estimated curvature are shown side by side.
    bool shows_both() const {
        return document_ && model_ && settings.source == ShownCurvature::both && settings.needs_curvature();
    }

    Playback playback;
    PoseControls pose;
    OrbitCamera camera;
    ViewSettings settings;
    Messages messages;
    FrameTimes times;
    std::unique_ptr<TrainingJob> training;
    std::unique_ptr<HatchingJob> hatching_job;
    bool show_panels = true, show_help = false, show_times = false;

  private:
    void open_document(const std::filesystem::path& path, ViewSize view);
    void open_labels(const std::filesystem::path& path);
    std::unique_ptr<Document> document_;  // scenes refer to it
    std::uint64_t document_version_ = 0, model_version_ = 0;
    std::size_t clip_ = 0;
    std::shared_ptr<const CurvatureModel> model_;
    std::string model_name_;
    std::shared_ptr<const HatchingStyle> hatching_;
    std::string hatching_name_;
};

}  // namespace exemplar
