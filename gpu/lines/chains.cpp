#include "gpu/lines/chains.h"

#include <bit>
#include <cstddef>

#include "embedded/lines_jump_comp.h"
#include "embedded/lines_links_comp.h"
#include "embedded/lines_nodes_comp.h"
#include "embedded/lines_points_comp.h"
#include "embedded/lines_rank_comp.h"
#include "embedded/lines_scan_comp.h"
#include "gpu/curvature/surface/texels.h"
#include "gpu/imaging/picture.h"
#include "shaders/shared/lines.h"

namespace exemplar {
namespace {

using shared::LineCounts;
using shared::LinePoint;
using shared::uvec4;
using shared::vec4;

const StructLayout k_word = layout_of<std::uint32_t>();

}  // namespace

GpuChains::GpuChains(GpuLineExtraction& lines) : lines_(lines) {
    Device& device = lines.surface().surface().device();
    const std::size_t room = lines.room();
    check_texels(device, 4 * room, "the chains of a surface's lines");
    link_kernel_ = Kernel(device, shaders::lines_links_comp,
                          {.push_constants = layout_of<shared::LinkParameters>(),
                           .elements = {layout_of<vec4>(), layout_of<uvec4>(), layout_of<uvec4>(), layout_of<uvec4>(),
                                        k_word, k_word, k_word, k_word, layout_of<uvec4>()}});
    node_kernel_ = Kernel(device, shaders::lines_nodes_comp, {.elements = {k_word, layout_of<vec4>()}});
    jump_kernel_ = Kernel(device, shaders::lines_jump_comp, {.elements = {layout_of<uvec4>()}});
    rank_kernel_ = Kernel(device, shaders::lines_rank_comp, {.elements = {layout_of<uvec4>(), k_word}});
    scan_kernel_ = Kernel(device, shaders::lines_scan_comp,
                          {.push_constants = layout_of<shared::ScanParameters>(), .constants = {{0, 1}}});
    point_kernel_ = Kernel(device, shaders::lines_points_comp,
                           {.elements = {layout_of<uvec4>(), k_word, k_word, layout_of<uvec4>(), layout_of<vec4>()}});
    const std::size_t needed = room > 1 ? static_cast<std::size_t>(std::bit_width(room - 1)) : 0;
    rounds_ = (needed + 1) / 2;
    rounds_ += rounds_ % 2;
    picture_ends_ = Buffer(device, 2 * room * sizeof(vec4));
    links_ = Buffer(device, 2 * room * sizeof(std::uint32_t));
    nodes_ = Buffer(device, 4 * room * sizeof(uvec4));
    other_nodes_ = Buffer(device, 4 * room * sizeof(uvec4));
    ranks_ = Buffer(device, room * sizeof(uvec4));
    point_counts_ = Buffer(device, room * sizeof(std::uint32_t));
    point_groups_ = Buffer(device, (room / shared::k_count_group + 1) * sizeof(std::uint32_t));
    points_ = Buffer(device, 2 * room * sizeof(LinePoint));
}

void GpuChains::record(Stream& stream, const Buffer& vertices, const Camera& camera, int width, int height) {
    const GpuLineSurface& surface = lines_.surface();
    Buffer& counts = lines_.counts();
    shared::LinkParameters parameters{
        .matrix = {}, .width = static_cast<float>(width), .height = static_cast<float>(height)};
    put_matrix(camera.view_projection(), parameters.matrix);
    constexpr std::size_t k_segments = offsetof(LineCounts, segment_groups),
                          k_nodes = offsetof(LineCounts, node_groups), k_rounds = offsetof(LineCounts, round_groups);
    stream.dispatch_indirect(link_kernel_, counts, k_segments,
                             {vertices, surface.surface().faces(), surface.joined_faces(), surface.neighbors(),
                              surface.face_begin(), surface.vertex_faces(), lines_.face_counts(), lines_.face_groups(),
                              lines_.segments(), counts, picture_ends_, links_},
                             parameters);
    stream.dispatch_indirect(node_kernel_, counts, k_nodes, {links_, picture_ends_, counts, nodes_});
    for (std::size_t round = 0; round < rounds_; ++round) {
        const bool back = round % 2 != 0;
        stream.dispatch_indirect(jump_kernel_, counts, k_rounds + round * sizeof(VkDispatchIndirectCommand),
                                 {back ? other_nodes_ : nodes_, counts, back ? nodes_ : other_nodes_});
    }
    stream.dispatch_indirect(rank_kernel_, counts, k_segments,
                             {nodes_, links_, counts, ranks_, point_counts_, point_groups_});
    stream.dispatch(scan_kernel_, 1, {point_groups_, counts}, shared::ScanParameters{.groups = 0, .most = 0});
    stream.dispatch_indirect(point_kernel_, counts, k_segments,
                             {ranks_, point_counts_, point_groups_, lines_.segments(), picture_ends_, counts, points_});
}

}  // namespace exemplar
