// exemplar hatch register: the camera of a drawing.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/exemplar/arguments.h"
#include "apps/exemplar/common_options.h"
#include "apps/exemplar/hatch/hatch_reading.h"
#include "apps/exemplar/hatch/view_file.h"
#include "apps/exemplar/lines/lines_source.h"
#include "host/core/files.h"
#include "host/core/progress.h"
#include "host/hatching/drawing/drawing_input.h"
#include "host/hatching/drawing/drawing_warp.h"
#include "host/hatching/registration/light_fit.h"
#include "host/hatching/registration/view_registration.h"
#include "host/hatching/tracing/view_outlines.h"
#include "host/imaging/gbuffer.h"
#include "host/imaging/pictures/picture_file.h"
#include "host/imaging/png.h"
#include "host/mesh/editing/drawable_mesh.h"
#include "host/mesh/editing/loose_vertices.h"

namespace exemplar {
namespace {

namespace fs = std::filesystem;

constexpr int k_most_pixels = 1000;      ///< longer side of a view; larger drawings are read at their own resolution
constexpr double k_min_explained = 0.5;  ///< share of the outline on lines of the drawing
constexpr double k_min_likeness = 0.3;   ///< correlation of the light with the tone, for a light to be told

struct RegisterArguments {
    fs::path mesh, drawing, out, overlay, shaded;
    std::size_t page = 0;
    CameraArguments camera;
    std::string light;
    bool place = false;
    FrameArguments frames;
    CommonOptions common;

    bool has_frames() const {
        return fs::is_directory(mesh) || !frames.range.empty() || !frames.clips.empty() || frames.most > 0;
    }
};

std::string numbers_text(const Vec3d& point) {
    return fmt::format("{:.7g},{:.7g},{:.7g}", point.x(), point.y(), point.z());
}

CameraArguments camera_options(const ViewPose& pose, const PoseFrame& frame) {
    const PlacedEye eye = placed_eye(pose, frame);
    CameraArguments camera;
    camera.eye = numbers_text(eye.eye);
    camera.target = numbers_text(eye.target);
    camera.up = numbers_text(eye.up);
    camera.field_of_view = std::round(eye.field_of_view * 1e5) / 1e5;
    camera.size = fmt::format("{}x{}", frame.width, frame.height);
    return camera;
}

/// The drawing in light gray, the object's outlines over it in red.
Image overlay_picture(const FloatImage& darkness, const TriangleMesh& mesh, const ViewPose& pose,
                      const PoseFrame& frame) {
    const ViewOutlines outlines =
        view_outlines(render_gbuffer(mesh, pose_camera(pose, frame), frame.width, frame.height));
    Image picture(frame.width, frame.height, 3);
    for (std::size_t i = 0; i < darkness.data.size(); ++i) {
        const float light = 1 - 0.5f * std::clamp(darkness.data[i], 0.0f, 1.0f);
        std::array<std::uint8_t, 3> color{};
        color.fill(static_cast<std::uint8_t>(std::lround(255 * light)));
        if (outlines.nearest[i] == static_cast<std::int32_t>(i)) color = {214, 0, 0};
        std::ranges::copy(color, picture.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
    }
    return picture;
}

TriangleMesh mesh_to_register(const fs::path& path, bool quiet) {
    MeshFile file = read_mesh(path);
    DrawableMesh drawable = drawable_mesh(file.mesh, path.string());
    file.mesh = std::move(drawable.mesh);
    mesh_warnings(file, path, quiet);
    return without_loose_vertices(file.mesh);
}

/// Returns an image scaled to another size.
FloatImage resized(const FloatImage& image, int width, int height) {
    if (image.width == width && image.height == height) return image;
    return warp_drawing(image, Similarity(static_cast<double>(width) / image.width, 0), width, height);
}

/// The drawing at the size of its view.
FloatImage drawing_at_view_size(const fs::path& path, std::size_t page) {
    const FloatImage darkness = read_darkness({path, page}, k_most_pixels);
    const double scale = std::min(1.0, static_cast<double>(k_most_pixels) / std::max(darkness.width, darkness.height));
    return resized(darkness, std::max(1, static_cast<int>(std::lround(scale * darkness.width))),
                   std::max(1, static_cast<int>(std::lround(scale * darkness.height))));
}

/// The pose that the camera's options give.
ViewPose given_pose(const CameraArguments& arguments, const TriangleMesh& mesh, const PoseFrame& frame) {
    CameraArguments sized = arguments;
    sized.size = fmt::format("{}x{}", frame.width, frame.height);
    const Camera camera = camera_of(sized, mesh).camera;
    const Eigen::Matrix3d axes = camera.view.topLeftCorner<3, 3>().cast<double>();
    const Vec3d eye = camera.position().cast<double>(), up = axes.row(1), backward = axes.row(2);
    return pose_of({eye, eye - backward, up, arguments.field_of_view}, frame);
}

/// Finds the light by the shaded picture, or guesses it by the tone of the drawing; returns it as --light takes it.
std::string found_light(const RegisterArguments& arguments, const TriangleMesh& mesh, const FloatImage& darkness,
                        const ViewPose& pose, const PoseFrame& frame) {
    if (!arguments.light.empty()) return arguments.light;
    FloatImage brightness = darkness;
    for (float& value : brightness.data) value = 1 - value;
    const bool shaded = !arguments.shaded.empty();
    if (shaded) brightness = resized(gray_over_white(read_picture(arguments.shaded)), frame.width, frame.height);
    const float smoothing = shaded ? 0.7f : 0.012f * static_cast<float>(frame.width);
    const LightFit fit = fit_light(brightness, mesh, pose, frame, smoothing);
    const bool told = fit.correlation >= k_min_likeness;
    const Vec3 light = told ? fit.direction : Vec3::UnitZ();
    std::string text = fmt::format("{:.3f},{:.3f},{:.3f}", light.x(), light.y(), light.z());
    if (arguments.common.quiet) return text;
    if (told)
        fmt::print("light: {} by the {} (correlation {:.2f}){}\n", text, shaded ? "shaded picture" : "drawing's tone",
                   fit.correlation, shaded ? "" : ": a guess, that --shaded or --light mend");
    else
        fmt::print("light: taken at the eye; the {} does not tell it. Say where it is with --light\n",
                   shaded ? "shaded picture" : "drawing's tone");
    return text;
}

void refuse_misfit(const RegisterArguments& arguments, const OutlineFit& fit) {
    if (fit.explained >= k_min_explained) return;
    throw DataError(fmt::format(
        "{}: no view of {} fits: at best {:.0f}% of its outline lie on lines of the drawing ({:.0f}% needed; see {}). "
        "Is it this mesh, and is the outline drawn? Else begin near the view, with --place and --eye",
        arguments.drawing.string(), arguments.mesh.string(), 100 * fit.explained, 100 * k_min_explained,
        arguments.overlay.string()));
}

void print_fit(const RegisterArguments& arguments, const CameraArguments& camera, const std::vector<OutlineFit>& fits) {
    fmt::print("{}: the outlines fit to {:.2f} pixels where they do, {:.0f}% of them; see {}\n", arguments.out.string(),
               fits[0].residual, 100 * fits[0].explained, arguments.overlay.string());
    fmt::print("  --eye={} --target={} --up={} --fov={} --size={}\n", camera.eye, camera.target, camera.up,
               camera.field_of_view, camera.size);
    if (!fits[0].outlined)
        fmt::print("  The outline is not drawn, so the border of the hatching was taken for it: look at the overlay\n");
    constexpr double k_alike = 1.3;
    if (fits.size() > 1 && fits[1].cost < k_alike * fits[0].cost)
        fmt::print("  Another view fits nearly as well; if the overlay is wrong inside, begin at yours with --place\n");
}

/// A mesh whose view was found.
struct FoundView {
    TriangleMesh mesh;
    fs::path path;  ///< of its file
    std::vector<OutlineFit> fits;
};

PoseFrame frame_of_drawing(const TriangleMesh& mesh, const FloatImage& darkness) {
    return pose_frame(mesh, darkness.width, darkness.height);
}

/// Draws the overlay of a fit, and refuses it if it is none.
void check_fit(const RegisterArguments& arguments, const TriangleMesh& mesh, const OutlineFit& fit,
               const FloatImage& darkness) {
    write_png(arguments.overlay, overlay_picture(darkness, mesh, fit.pose, frame_of_drawing(mesh, darkness)));
    refuse_misfit(arguments, fit);
}

FoundView registered_mesh(const RegisterArguments& arguments, const FloatImage& darkness) {
    FoundView found{mesh_to_register(arguments.mesh, arguments.common.quiet), arguments.mesh, {}};
    Progress progress("searching the view", k_registration_steps);
    RegistrationOptions options;
    options.step = [&] { progress.advance(); };
    if (arguments.place)
        options.start = given_pose(arguments.camera, found.mesh, frame_of_drawing(found.mesh, darkness));
    found.fits = register_view(found.mesh, darkness, options);
    progress.finish();
    check_fit(arguments, found.mesh, found.fits[0], darkness);
    return found;
}

/// Finds the frame of an animation that is drawn, and writes its mesh beside the view.
FoundView registered_frame(const RegisterArguments& arguments, const FloatImage& darkness) {
    LinesSourceArguments input;
    input.input = arguments.mesh;
    input.frames = arguments.frames;
    input.quiet = arguments.common.quiet;
    const LinesSource source(input);
    const auto mesh_of = [&](std::size_t frame) { return without_loose_vertices(source.mesh(frame)); };
    Progress progress("searching frames and views", k_frame_registration_steps);
    RegisteredFrame registered = register_frame(source.frame_count(), mesh_of, darkness, [&] { progress.advance(); });
    progress.finish();
    const TriangleMesh mesh = mesh_of(registered.frame);
    check_fit(arguments, mesh, registered.fit, darkness);
    const fs::path path = arguments.out.parent_path() / (arguments.out.stem().string() + "_frame.ply");
    write_ply(path, mesh);
    if (!arguments.common.quiet)
        fmt::print("{}: frame {} of {}, the mesh to learn from\n", path.string(), registered.frame,
                   source.frame_count());
    FoundView found{mesh_to_register(path, true), path, {registered.fit}};
    // Reading the file may drop faces without area, which can move the middle of the mesh, to which poses refer.
    found.fits[0].pose = pose_of(placed_eye(registered.fit.pose, frame_of_drawing(mesh, darkness)),
                                 frame_of_drawing(found.mesh, darkness));
    return found;
}

void report_view(const RegisterArguments& arguments, const FoundView& found, const FloatImage& darkness) {
    const PoseFrame frame = frame_of_drawing(found.mesh, darkness);
    const CameraArguments camera = camera_options(found.fits[0].pose, frame);
    if (!arguments.common.quiet) print_fit(arguments, camera, found.fits);
    const std::string light = found_light(arguments, found.mesh, darkness, found.fits[0].pose, frame);
    const ViewFile view{{camera, light}, drawn_mesh(found.path, found.mesh), {}, arguments.drawing.filename().string()};
    write_file_atomically(arguments.out, [&](std::ostream& out) { out << view_file_text(view) << '\n'; });
    write_report(arguments.common, {{"eye", camera.eye},
                                    {"target", camera.target},
                                    {"up", camera.up},
                                    {"fov", camera.field_of_view},
                                    {"size", camera.size},
                                    {"light", light},
                                    {"residual", found.fits[0].residual},
                                    {"explained", found.fits[0].explained},
                                    {"cost", found.fits[0].cost}});
}

void run_register(RegisterArguments& arguments) {
    const auto limits = apply_common_options(arguments.common);
    for (const fs::path& path : {arguments.mesh, arguments.drawing, arguments.shaded})
        if (!path.empty()) require_input(path);
    require_camera(arguments.camera);
    if (arguments.place && arguments.has_frames())
        throw UsageError("--place begins at a view of one mesh; give that of the frame that is drawn");
    if (arguments.place && arguments.camera.field_of_view <= 0)
        throw UsageError("--place begins at a view in perspective; give --fov a small angle");
    if (!arguments.light.empty()) point_of(arguments.light, "--light");
    require_output_file(arguments.out);
    if (arguments.overlay.empty())
        arguments.overlay = arguments.out.parent_path() / (arguments.out.stem().string() + "_overlay.png");
    require_output_picture(arguments.overlay);
    require_not_replaced(arguments.out, {arguments.mesh, arguments.drawing, arguments.shaded});
    require_not_replaced(arguments.overlay, {arguments.mesh, arguments.drawing, arguments.shaded});
    const FloatImage darkness = drawing_at_view_size(arguments.drawing, arguments.page);
    const bool frames = arguments.has_frames();
    report_view(arguments, frames ? registered_frame(arguments, darkness) : registered_mesh(arguments, darkness),
                darkness);
}

}  // namespace

void add_hatch_register_command(Command& hatch) {
    auto arguments = std::make_shared<RegisterArguments>();
    Command* command = hatch.add_subcommand("register", "Finds the camera of a drawing by its outlines");
    command->footer(
        "For drawings that were not made over a template. All sides, distances and places are searched. Writes the "
        "view,\n"
        "which other commands take as --template, and the mesh's outlines over the drawing, to check. Of an animation "
        "(a\n"
        "folder, or a file with --frames), the frame that is drawn is searched, too, and its mesh is "
        "written.\n\nExample:\n"
        "  exemplar hatch register bunny.off drawing.png --out view.json\n"
        "  exemplar hatch train bunny.off drawing.png --template view.json --out mine.safetensors");
    command->add_option("MESH", arguments->mesh, "mesh that the drawing shows")->required()->type_name("");
    command->add_option("DRAWING", arguments->drawing, "the drawing, with outlines (PNG, JPEG, TIFF or SVG)")
        ->required()
        ->type_name("");
    add_page_option(*command, arguments->page);
    command->add_option("--out", arguments->out, "the view to write (JSON)")->required()->type_name("FILE");
    command->add_option("--overlay", arguments->overlay, "the picture to check it by; default: NAME_overlay.png")
        ->type_name("FILE");
    Option* shaded = command
                         ->add_option("--shaded", arguments->shaded,
                                      "a shaded picture of the same view, in place of the drawing's tone, to find "
                                      "the light by (PNG, JPEG or TIFF)")
                         ->type_name("FILE");
    command
        ->add_option("--light", arguments->light,
                     "direction to the light as the eye has it, where it is known: to the right, up, towards the eye")
        ->type_name("X,Y,Z")
        ->excludes(shaded);
    add_frame_options(*command, arguments->frames, "", "search");
    command->add_flag("--place", arguments->place,
                      "begins at the view that the options of the camera give, instead of searching");
    add_camera_options(*command, arguments->camera);
    add_common_options(*command, arguments->common);
    command->callback([arguments] { run_register(*arguments); });
}

}  // namespace exemplar
