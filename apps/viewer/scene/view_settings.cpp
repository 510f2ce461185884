#include "apps/viewer/scene/view_settings.h"

namespace exemplar {

void ViewSettings::set_style(const DrawingStyle& next) {
    style = next;
    ++style_version;
    background = next.background.value_or(Color{255, 255, 255});
    plain = next.shading == SurfaceShading::none ? background : next.surface;
    switch (next.shading) {
        case SurfaceShading::none:
        case SurfaceShading::paper:
            light = SurfaceLight::none;
            break;
        case SurfaceShading::shaded:
            light = SurfaceLight::smooth;
            break;
        case SurfaceShading::toon:
            light = SurfaceLight::steps;
            break;
    }
}

}  // namespace exemplar
