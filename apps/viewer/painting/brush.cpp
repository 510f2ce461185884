#include "apps/viewer/painting/brush.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "host/imaging/scan_conversion.h"

namespace exemplar {
namespace {

/// A range of pixels, clipped to the picture.
struct PixelBox {
    int left, top, right, bottom;  ///< right and bottom are outside
};

PixelBox box_around(const FacePicture& picture, const Vec2& low, const Vec2& high) {
    const auto clipped = [](float value, int size) {
        return static_cast<int>(std::clamp(value, 0.0F, static_cast<float>(size)));
    };
    return {clipped(std::floor(low.x()), picture.width), clipped(std::floor(low.y()), picture.height),
            clipped(std::ceil(high.x()) + 1, picture.width), clipped(std::ceil(high.y()) + 1, picture.height)};
}

std::uint32_t face_of_pixel(const FacePicture& picture, int x, int y) {
    return picture
        .face[static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(x)];
}

float squared_distance_to_segment(const Vec2& point, const Vec2& from, const Vec2& to) {
    const Vec2 along = to - from;
    const float length = along.squaredNorm();
    const float t = length > 0 ? std::clamp((point - from).dot(along) / length, 0.0F, 1.0F) : 0.0F;
    return (point - from - t * along).squaredNorm();
}

bool inside_polygon(const Vec2& point, std::span<const Vec2> polygon) {
    bool inside = false;
    for (std::size_t i = 0, j = polygon.size() - 1; i < polygon.size(); j = i++) {
        const Vec2 &a = polygon[i], &b = polygon[j];
        if ((a.y() > point.y()) == (b.y() > point.y())) continue;
        if (point.x() < (b.x() - a.x()) * (point.y() - a.y()) / (b.y() - a.y()) + a.x()) inside = !inside;
    }
    return inside;
}

/// Returns the faces whose center projects to a place for which `touched` holds.
template <typename Touched>
std::vector<std::uint32_t> projected_faces(const TriangleMesh& mesh, const FacePicture& picture,
                                           const Touched& touched) {
    const std::vector<Vec3> center = face_centers(mesh);
    std::vector<std::uint32_t> faces;
    for (std::uint32_t f = 0; f < center.size(); ++f) {
        const Vec3 place = picture.camera.project(center[f], picture.width, picture.height);
        if (place.z() >= 0 && place.z() <= 1 && touched(Vec2(place.x(), place.y()))) faces.push_back(f);
    }
    return faces;
}

}  // namespace

std::uint32_t face_at(const FacePicture& picture, const Vec2& pixel) {
    const auto x = static_cast<int>(std::floor(pixel.x())), y = static_cast<int>(std::floor(pixel.y()));
    if (x < 0 || y < 0 || x >= picture.width || y >= picture.height) return k_no_face;
    return face_of_pixel(picture, x, y);
}

std::uint32_t face_near(const FacePicture& picture, const Vec2& pixel, float radius) {
    const Vec2 reach(radius, radius);
    const PixelBox box = box_around(picture, pixel - reach, pixel + reach);
    std::uint32_t nearest = k_no_face;
    float least = radius * radius;
    for (int y = box.top; y < box.bottom; ++y)
        for (int x = box.left; x < box.right; ++x) {
            const Vec2 center(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            const float distance = (center - pixel).squaredNorm();
            if (distance > least || face_of_pixel(picture, x, y) == k_no_face) continue;
            least = distance;
            nearest = face_of_pixel(picture, x, y);
        }
    return nearest;
}

std::vector<std::uint32_t> brushed_faces(const FacePicture& picture, const Vec2& from, const Vec2& to, float radius) {
    const Vec2 reach(radius, radius);
    const PixelBox box = box_around(picture, from.cwiseMin(to) - reach, from.cwiseMax(to) + reach);
    std::vector<std::uint32_t> faces;
    for (int y = box.top; y < box.bottom; ++y)
        for (int x = box.left; x < box.right; ++x) {
            const std::uint32_t face = face_of_pixel(picture, x, y);
            const Vec2 center(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            if (face != k_no_face && squared_distance_to_segment(center, from, to) <= radius * radius)
                faces.push_back(face);
        }
    std::ranges::sort(faces);
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
}

std::vector<std::uint32_t> faces_in_lasso(const FacePicture& picture, std::span<const Vec2> polygon) {
    if (polygon.size() < 3) return {};
    std::map<std::uint32_t, int> balance;  // pixels inside minus pixels outside
    for (int y = 0; y < picture.height; ++y)
        for (int x = 0; x < picture.width; ++x) {
            const std::uint32_t face = face_of_pixel(picture, x, y);
            if (face == k_no_face) continue;
            const Vec2 center(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
            balance[face] += inside_polygon(center, polygon) ? 1 : -1;
        }
    std::vector<std::uint32_t> faces;
    for (const auto& [face, pixels] : balance)
        if (pixels > 0) faces.push_back(face);
    return faces;
}

std::vector<std::uint32_t> brushed_faces_through(const TriangleMesh& mesh, const FacePicture& picture, const Vec2& from,
                                                 const Vec2& to, float radius) {
    return projected_faces(mesh, picture, [&](const Vec2& place) {
        return squared_distance_to_segment(place, from, to) <= radius * radius;
    });
}

std::vector<std::uint32_t> faces_in_lasso_through(const TriangleMesh& mesh, const FacePicture& picture,
                                                  std::span<const Vec2> polygon) {
    if (polygon.size() < 3) return {};
    return projected_faces(mesh, picture, [&](const Vec2& place) { return inside_polygon(place, polygon); });
}

}  // namespace exemplar
