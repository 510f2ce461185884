#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "apps/viewer/controls/orbit_camera.h"
#include "host/imaging/camera.h"
#include "host/mesh/mesh.h"

namespace exemplar {

/// The faces that a view shows: what painting in the picture touches.
struct FacePicture {
    int width = 0, height = 0;
    std::vector<std::uint32_t> face;  ///< per pixel, row by row from the top left; k_no_face where there is none
    Camera camera;
};

/// Returns the face at a pixel; k_no_face beside the mesh or the picture.
std::uint32_t face_at(const FacePicture& picture, const Vec2& pixel);
/// Returns the face that is seen nearest to a pixel, at most `radius` pixels away; k_no_face if there is none.
std::uint32_t face_near(const FacePicture& picture, const Vec2& pixel, float radius);

/// Returns the faces that a round brush of `radius` pixels touches on its way from `from` to `to`, each once, in
/// increasing order. Only what is seen is touched.
std::vector<std::uint32_t> brushed_faces(const FacePicture& picture, const Vec2& from, const Vec2& to, float radius);
/// Returns the faces most of whose pixels lie in a closed polygon, by the even-odd rule. Only what is seen counts.
std::vector<std::uint32_t> faces_in_lasso(const FacePicture& picture, std::span<const Vec2> polygon);

/// The same for all faces, hidden ones as well: those whose center projects to a place under the brush, or in the
/// polygon.
std::vector<std::uint32_t> brushed_faces_through(const TriangleMesh& mesh, const FacePicture& picture, const Vec2& from,
                                                 const Vec2& to, float radius);
std::vector<std::uint32_t> faces_in_lasso_through(const TriangleMesh& mesh, const FacePicture& picture,
                                                  std::span<const Vec2> polygon);

}  // namespace exemplar
