#include "apps/exemplar/curvature/curvature_pictures.h"

#include <fmt/format.h>

#include <cctype>
#include <string>

#include "host/imaging/camera.h"
#include "host/imaging/png.h"
#include "host/imaging/raster.h"
#include "host/imaging/side_by_side.h"

namespace exemplar {
namespace {

constexpr int k_width = 480, k_height = 560;
constexpr Color k_plain{236, 236, 232}, k_right{0, 0, 0}, k_missing{40, 90, 230}, k_wrong{225, 40, 30};

using Marks = std::vector<std::uint8_t>;

std::vector<Color> colors_of(const Marks& truth, const Marks& guess) {
    std::vector<Color> colors(truth.size(), k_plain);
    for (std::size_t f = 0; f < truth.size(); ++f)
        if (truth[f] || guess[f]) colors[f] = !guess[f] ? k_missing : !truth[f] ? k_wrong : k_right;
    return colors;
}

/// Returns a safe file name: clips may have any name, and "../x" must not lead out of the folder.
std::string file_name_of(std::string clip) {
    for (char& c : clip)
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
    constexpr std::size_t k_longest = 60;
    return clip.substr(0, k_longest);
}

}  // namespace

void write_line_pictures(const std::filesystem::path& folder, const CurvatureModel& model, const Animation& animation,
                         FrameRef frame) {
    const FrameCurvature at = curvature_at(model, animation, frame);
    TriangleMesh mesh = animation.rest;
    mesh.vertices = at.snapshot.vertices;
    const Camera camera = fit_camera(mesh, Vec3(0.5f, 0.3f, 1), float(k_width) / k_height);
    for (const LineType type : compared_lines()) {
        const auto marks = [&](const VertexCurvature& curvature) {
            return classify_faces({mesh.faces, mesh.vertices, at.snapshot.normals, curvature}, type,
                                  {.eye = camera.position(), .feature_size = model.feature_size, .thresholds = {}});
        };
        const Marks truth = marks(at.snapshot.curvature);
        std::vector<Image> images;
        for (const VertexCurvature* curvature : {&at.snapshot.curvature, &at.learned, &at.zero_order})
            images.push_back(render_mesh(mesh, colors_of(truth, marks(*curvature)), camera, k_width, k_height));
        write_png(folder / fmt::format("{}_{:04d}_{}.png", file_name_of(animation.clips[frame.clip].name), frame.frame,
                                       name_of(type)),
                  side_by_side(images));
    }
}

}  // namespace exemplar
