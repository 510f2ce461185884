#include "host/lines/strokes/view_point.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "host/core/errors.h"
#include "tests/support/shapes.h"

namespace exemplar {
namespace {

/// The farthest that any vertex is from the middle of the picture, as a share of half its width or height.
float farthest(const ViewPoint& point, const TriangleMesh& mesh) {
    const Camera camera = camera_at(point, mesh);
    float most = 0;
    for (const Vec3& vertex : mesh.vertices) {
        const Eigen::Vector4f clip = camera.view_projection() * vertex.homogeneous();
        most = std::max(most, clip.head<2>().cwiseAbs().maxCoeff() / clip.w());
    }
    return most;
}

TEST(ViewPoints, ShowAllOfASurfaceAsLargeAsItFits) {
    const TriangleMesh mesh = shapes::translated(shapes::box(1, 3, 2, 2), {5, -2, 7});
    for (const std::string& name : view_names())
        for (const double field_of_view : {0.0, 23.0, 90.0}) {
            ViewPoint point;
            point.view = name;
            point.field_of_view = field_of_view;
            EXPECT_NEAR(farthest(point, mesh), 0.95f, 0.01f) << name << ' ' << field_of_view;
        }
}

TEST(ViewPoints, OfNamesTurnWithWhatIsUp) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    ViewPoint point;
    point.view = "top";
    point.up = Vec3::UnitZ();
    EXPECT_GT(camera_at(point, mesh).position().z(), 1);
    EXPECT_FALSE(view_direction("inside"));
}

TEST(ViewPoints, StandAtTheEye) {
    const TriangleMesh mesh = shapes::box(1, 1, 1, 1);
    ViewPoint point;
    point.eye = Vec3(3, 1, 2);
    EXPECT_LT((camera_at(point, mesh).position() - *point.eye).norm(), 1e-4f);
    const StrokeView view = stroke_view(point, mesh, 0.5f);
    EXPECT_EQ(view.feature_size, 0.5f);
    EXPECT_EQ(view.width, 1000);
    EXPECT_NEAR(view.unit_depth, point.eye->norm(), 1e-3f);  // the box is around the origin
    point.target = point.eye;
    EXPECT_THROW(camera_at(point, mesh), UsageError);
}

}  // namespace
}  // namespace exemplar
