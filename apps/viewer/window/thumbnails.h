#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "apps/viewer/painting/labeling_session.h"
#include "gpu/window/ui_renderer.h"

namespace exemplar {

/// The thumbnails of a session on the device, in one strip.
class ThumbnailStrip {
  public:
    /// Uploads the thumbnails if one has changed.
    void follow(const LabelingSession& session, UiRenderer& renderer);

  private:
    const LabelingSession* session_ = nullptr;
    std::uint64_t version_ = 0;
};

/// Draws a shape's thumbnail as an image of that height, in units of the window; a blank one while there is none.
void draw_thumbnail(const LabelingSession& session, std::size_t shape, float height);

}  // namespace exemplar
