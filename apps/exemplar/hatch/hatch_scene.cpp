#include "apps/exemplar/hatch/hatch_scene.h"
#include "apps/exemplar/ink_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "apps/exemplar/arguments.h"
#include "gpu/hatching/hatching_device.h"
#include "host/core/errors.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/editing/loose_vertices.h"
#include "host/mesh/io/io.h"
#include "host/mesh/label_files/label_files.h"

namespace exemplar {

std::vector<Option*> add_hatch_scene_options(Command& command, HatchSceneArguments& arguments) {
    arguments.camera.size = "1000x1000";
    std::vector<Option*> options = add_camera_options(command, arguments.camera);
    options.push_back(command
                          .add_option("--light", arguments.light,
                                      "direction to the light as the eye has it: to the right, up, towards the eye")
                          ->type_name("X,Y,Z")
                          ->capture_default_str());
    command.add_option("--cache", arguments.cache, "folder that remembers measured surfaces; '' remembers none")
        ->type_name("FOLDER")
        ->capture_default_str();
    return options;
}

void add_template_option(Command& command, HatchSceneArguments& arguments, const std::vector<Option*>& told) {
    Option* option = command
                         .add_option("--template", arguments.view_file,
                                     "the picture that 'hatch template' wrote, or the view that 'hatch register' "
                                     "found: tells camera, light and size")
                         ->type_name("FILE");
    for (Option* each : told) each->excludes(option);
}

void require_hatch_scene(HatchSceneArguments& arguments) {
    require_input(arguments.mesh);
    if (!arguments.view_file.empty()) {
        require_input(arguments.view_file);
        ViewFile file = read_view_file(arguments.view_file);
        arguments.camera = file.view.camera;
        arguments.light = file.view.light;
        arguments.drawn = std::move(file.mesh);
        arguments.sheet = file.sheet;
        arguments.registered = !file.drawing.empty();
    }
    if (!arguments.labels.empty()) require_input(arguments.labels);
    require_inks({arguments.labels, arguments.materials});
    require_camera(arguments.camera);
    if (!(point_of(arguments.light, "--light").norm() > 0))
        throw UsageError("--light is zero; give a direction as -0.5,0.5,0.7");
}

HatchingView hatching_view(const HatchSceneArguments& arguments, const TriangleMesh& mesh) {
    const SizedCamera sized = camera_of(arguments.camera, mesh);
    return {sized.camera, light_from(sized.camera, point_of(arguments.light, "--light")), sized.width, sized.height,
            point_of(arguments.camera.up, "--up").normalized()};
}

HatchingInks read_hatching_inks(const HatchSceneArguments& arguments, const MeshFile& file) {
    const InkArguments inks{arguments.labels, arguments.materials};
    return {read_inks(inks, arguments.mesh, file, &PartMaterial::hatching),
            read_inks(inks, arguments.mesh, file, &PartMaterial::line),
            {}};
}

struct HatchScene::Impl {
    explicit Impl(const std::string& name) : device({.name = name}) {}
    HatchingDevice device;
    HatchingSurface surface;
    HatchingView view;
    std::unique_ptr<PixelFeatures> pixels;
    HatchingInks inks;
};

HatchScene::HatchScene(const HatchSceneArguments& arguments, const std::string& device, bool quiet)
    : impl_(std::make_unique<Impl>(device)) {
    MeshFile file = read_mesh(arguments.mesh);
    DrawableMesh drawable = drawable_mesh(file.mesh, arguments.mesh.string());
    file.mesh = std::move(drawable.mesh);
    std::ranges::move(drawable.warnings, std::back_inserter(file.warnings));
    mesh_warnings(file, arguments.mesh, quiet);
    impl_->surface =
        cached_surface(without_loose_vertices(file.mesh), usable_cache(arguments.cache, quiet, "measured surfaces"));
    if (arguments.drawn)
        require_mesh_of_view(arguments.view_file, *arguments.drawn, drawn_mesh(arguments.mesh, impl_->surface.mesh));
    impl_->view = hatching_view(arguments, impl_->surface.mesh);
    impl_->pixels = std::make_unique<PixelFeatures>(impl_->surface, impl_->view, impl_->device.tools().images);
    if (!arguments.labels.empty()) impl_->pixels->set_labels(read_face_labels(arguments.labels, file.mesh));
    impl_->inks = read_hatching_inks(arguments, file);
    if (!impl_->inks.strokes.empty()) impl_->inks.face = impl_->pixels->gbuffer().face;
}

HatchScene::~HatchScene() = default;

const HatchingSurface& HatchScene::surface() const {
    return impl_->surface;
}
PixelFeatures& HatchScene::pixels() {
    return *impl_->pixels;
}
const HatchingTools& HatchScene::tools() const {
    return impl_->device.tools();
}
const HatchingInks& HatchScene::inks() const {
    return impl_->inks;
}
const std::string& HatchScene::device_name() const {
    return impl_->device.device().info().name;
}

}  // namespace exemplar
