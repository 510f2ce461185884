#pragma once

#include <vector>

#include "apps/viewer/painting/labeling_session.h"

namespace exemplar {

/// A movement of the mouse with its button held, which paints with the tool of the session's settings. Places are
/// pixels of the picture.
class PaintGesture {
  public:
    /// Begins: a fill is done at once, a brush paints its first spot.
    void press(LabelingSession& session, const FacePicture& picture, const Vec2& at);
    /// Goes on to a place.
    void drag(LabelingSession& session, const FacePicture& picture, const Vec2& to);
    /// Ends: a lasso is closed, and the strokes are kept in a file.
    void release(LabelingSession& session, const FacePicture& picture);
    bool active() const { return active_; }
    /// The way so far; for the outline of a lasso.
    const std::vector<Vec2>& way() const { return way_; }

  private:
    bool active_ = false;
    std::vector<Vec2> way_;
};

}  // namespace exemplar
