#include "apps/viewer/window/thumbnails.h"

#include <imgui.h>

#include <algorithm>

namespace exemplar {
namespace {

constexpr std::size_t k_texels = static_cast<std::size_t>(FolderJob::k_thumbnail_width) * FolderJob::k_thumbnail_height;
constexpr std::size_t k_max_thumbnails = 1000;  ///< 62 MB; shapes beyond have none

}  // namespace

void ThumbnailStrip::follow(const LabelingSession& session, UiRenderer& renderer) {
    const std::size_t count = std::min(session.folder().shapes().size(), k_max_thumbnails);
    if (session_ == &session && version_ == session.thumbnail_version()) return;
    session_ = &session;
    version_ = session.thumbnail_version();
    std::vector<std::uint32_t> texels(count * k_texels, 0xffd0d4d6);
    for (std::size_t s = 0; s < count; ++s) {
        const std::optional<Image>& image = session.shape_info(s).thumbnail;
        if (!image) continue;
        for (std::size_t t = 0; t < k_texels; ++t)
            texels[s * k_texels + t] =
                image->data[3 * t] | image->data[3 * t + 1] << 8 | image->data[3 * t + 2] << 16 | 0xff000000u;
    }
    renderer.set_pictures(texels, FolderJob::k_thumbnail_width,
                          static_cast<std::uint32_t>(count) * FolderJob::k_thumbnail_height);
}

void draw_thumbnail(const LabelingSession& session, std::size_t shape, float height) {
    const float width = height * FolderJob::k_thumbnail_width / FolderJob::k_thumbnail_height;
    const auto count = static_cast<float>(std::min(session.folder().shapes().size(), k_max_thumbnails));
    const auto place = static_cast<float>(shape);
    if (place >= count) return ImGui::Dummy(ImVec2(width, height));
    ImGui::Image(picture_texture(), ImVec2(width, height), ImVec2(0, place / count), ImVec2(1, (place + 1) / count));
}

}  // namespace exemplar
