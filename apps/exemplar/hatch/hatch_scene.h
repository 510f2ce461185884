#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/exemplar/commands.h"
#include "apps/exemplar/hatch/view_file.h"
#include "apps/exemplar/lines/lines_camera.h"
#include "apps/help/command.h"
#include "host/hatching/features/hatching_surface.h"
#include "host/hatching/features/pixel_features.h"
#include "host/hatching/features/surface_cache.h"
#include "host/hatching/hatching_drawing.h"
#include "host/hatching/view_hatching.h"
#include "host/mesh/io/io.h"

namespace exemplar {

/// Arguments of the scene of 'exemplar hatch': a mesh, the camera and the light.
struct HatchSceneArguments {
    std::filesystem::path view_file;  ///< tells camera and light, if it is not empty
    std::optional<DrawnMesh> drawn;   ///< the mesh that it tells of
    std::string sheet;                ///< paper that the view was printed on; empty: none
    bool registered = false;          ///< whether drawings show exactly this view
    std::filesystem::path mesh;
    std::filesystem::path labels;     ///< of the mesh's parts; empty: none
    std::filesystem::path materials;  ///< inks of the parts; empty: none
    CameraArguments camera;
    std::string light = "-0.45,0.55,0.7";                    ///< direction to it: x right, y up, z towards the eye
    std::filesystem::path cache = default_surface_folder();  ///< cache of measured surfaces; empty: none
};
/// Adds and returns the options of camera and light.
std::vector<Option*> add_hatch_scene_options(Command& command, HatchSceneArguments& arguments);
/// Adds --template, which stands for `told`, the options of camera and light.
void add_template_option(Command& command, HatchSceneArguments& arguments, const std::vector<Option*>& told);
/// Reads the view file, if there is one, and checks what can be checked before any work; throws UsageError or
/// DataError.
void require_hatch_scene(HatchSceneArguments& arguments);
/// Returns the view of a mesh.
HatchingView hatching_view(const HatchSceneArguments& arguments, const TriangleMesh& mesh);

/// Returns the inks of a hatched mesh's parts by its labels, without faces of pixels; empty ones without materials.
HatchingInks read_hatching_inks(const HatchSceneArguments& arguments, const MeshFile& file);

/// A mesh in a view, and everything that measures and hatches it on a device.
class HatchScene {
  public:
    /// Reads the mesh, and measures it or loads its measurements from the cache. Prints its defects unless `quiet`.
    HatchScene(const HatchSceneArguments& arguments, const std::string& device, bool quiet);
    ~HatchScene();

    const HatchingSurface& surface() const;
    PixelFeatures& pixels();
    const HatchingTools& tools() const;
    /// The inks of the parts; empty ones without materials.
    const HatchingInks& inks() const;
    const std::string& device_name() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace exemplar
