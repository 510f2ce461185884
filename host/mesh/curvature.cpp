#include "host/mesh/curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "host/core/parallel.h"

namespace exemplar {

namespace {

constexpr std::size_t k_grain = 4096;  // faces or vertices that one thread takes at a time

/// The second fundamental form in some tangent frame: (II11, II12, II22).
using Form = std::array<float, 3>;
/// Its derivative: (C111, C112, C122, C222).
using Derivative = std::array<float, 4>;

/// A rotation in the tangent plane.
struct Turn {
    float cosine = 1, sine = 0;
    Turn inverse() const { return {cosine, -sine}; }
};

/// `form` in the frame that is turned by `turn` from its own.
Form turned(const Form& form, Turn turn) {
    const float cc = turn.cosine * turn.cosine, cs = turn.cosine * turn.sine, ss = turn.sine * turn.sine;
    return {cc * form[0] + 2 * cs * form[1] + ss * form[2], cs * (form[2] - form[0]) + (cc - ss) * form[1],
            ss * form[0] - 2 * cs * form[1] + cc * form[2]};
}

Derivative turned(const Derivative& d, Turn turn) {
    const float c = turn.cosine, s = turn.sine;
    const float ccc = c * c * c, ccs = c * c * s, css = c * s * s, sss = s * s * s;
    return {ccc * d[0] + 3 * ccs * d[1] + 3 * css * d[2] + sss * d[3],
            -ccs * d[0] + (ccc - 2 * css) * d[1] + (2 * ccs - sss) * d[2] + css * d[3],
            css * d[0] + (sss - 2 * ccs) * d[1] + (ccc - 2 * css) * d[2] + ccs * d[3],
            -sss * d[0] + 3 * css * d[1] - 3 * ccs * d[2] + ccc * d[3]};
}

/// Solves the symmetric tridiagonal positive definite system with this diagonal and off-diagonal.
template <std::size_t N>
std::array<float, N> solve_tridiagonal(std::array<double, N> diagonal, const std::array<double, N - 1>& off,
                                       std::array<double, N> right) {
    for (std::size_t i = 1; i < N; ++i) {
        const double factor = off[i - 1] / diagonal[i - 1];
        diagonal[i] -= factor * off[i - 1];
        right[i] -= factor * right[i - 1];
    }
    std::array<float, N> solution;
    double next = 0;
    for (std::size_t i = N; i-- > 0;) {
        if (i + 1 < N) right[i] -= off[i] * next;
        next = right[i] / diagonal[i];
        solution[i] = static_cast<float>(next);
    }
    return solution;
}

/// What both fits of a face need. Edge i runs from corner i + 1 to corner i + 2; (u, v) are its coordinates in the
/// face's own frame. Turn i leads from that frame to the one of corner i, laid flat by the least rotation.
struct FaceFit {
    std::array<float, 3> u, v;
    std::array<Turn, 3> turn;
    std::array<float, 3> corner_area;  ///< zero in a degenerate face
    bool valid = false;
};

/// The part of a triangle that is nearest to each corner (Meyer et al. 2003), from its squared edge lengths; where an
/// angle is obtuse the Voronoi cells are cut off at the opposite edge.
std::array<float, 3> voronoi_areas(const std::array<double, 3>& squared_length, double area) {
    const auto& l = squared_length;
    std::array<float, 3> result;
    const double sum = l[0] + l[1] + l[2];
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        if (2 * l[i] >= sum) {
            // Beside an obtuse angle at corner i a corner keeps a right triangle over half its edge to i:
            // an eighth of that edge's squared length times the tangent of its own angle.
            const double at_j = l[k] * area / (2 * (sum - 2 * l[j])), at_k = l[j] * area / (2 * (sum - 2 * l[k]));
            result[j] = static_cast<float>(at_j);
            result[k] = static_cast<float>(at_k);
            result[i] = static_cast<float>(area - at_j - at_k);
            return result;
        }
    }
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t j = (i + 1) % 3, k = (i + 2) % 3;
        result[i] = static_cast<float>((l[j] * (sum - 2 * l[j]) + l[k] * (sum - 2 * l[k])) / (32 * area));
    }
    return result;
}

/// The axes of a face and its normal.
struct FaceFrame {
    Vec3 tangent, bitangent, normal;
};

/// Fills in edges and corner areas; false for a degenerate face.
bool measure_face(const TriangleMesh& mesh, const Face& face, FaceFit& fit, FaceFrame& frame) {
    const Vec3d p0 = mesh.vertices[face[0]].cast<double>(), p1 = mesh.vertices[face[1]].cast<double>(),
                p2 = mesh.vertices[face[2]].cast<double>();
    const Vec3d e0 = p2 - p1, e1 = p0 - p2, e2 = p1 - p0;
    const Vec3d n = e0.cross(e1);
    const std::array<double, 3> squared = {e0.squaredNorm(), e1.squaredNorm(), e2.squaredNorm()};
    const double longest = std::max({squared[0], squared[1], squared[2]});
    const double twice_area = n.norm();
    // Thinner slivers are rounding noise, and the differences of squares in voronoi_areas would vanish.
    if (!(twice_area > 1e-7 * longest)) return false;

    const double length = std::sqrt(squared[0]);
    const double along = e0.dot(e1) / length, height = twice_area / length;
    fit.u = {static_cast<float>(length), static_cast<float>(along), static_cast<float>(-length - along)};
    fit.v = {0.0f, static_cast<float>(height), static_cast<float>(-height)};
    fit.corner_area = voronoi_areas(squared, 0.5 * twice_area);
    frame.tangent = (e0 / length).cast<float>();
    frame.normal = (n / twice_area).cast<float>();
    frame.bitangent = frame.normal.cross(frame.tangent);
    return true;
}

/// The turn from the face's frame to a vertex frame with first axis `axis`, laid flat into the face by the least
/// rotation; `normal` is the vertex normal in the face's frame.
Turn turn_to_vertex(const FaceFrame& frame, const Vec3& axis, const Vec3& normal) {
    const float one_plus = 1 + normal.z();
    // Opposite normals have no least rotation; their common plane will do.
    const float tilt = one_plus > 1e-6f ? frame.normal.dot(axis) / one_plus : 0.0f;
    return {frame.tangent.dot(axis) - normal.x() * tilt, frame.bitangent.dot(axis) - normal.y() * tilt};
}

/// Least-squares second fundamental form of a face from the change of the vertex normals along its edges
/// (Rusinkiewicz 2004, Sec. 2), given those normals in the face's frame.
Form fit_form(const FaceFit& fit, const std::array<Vec3, 3>& normals) {
    double uu = 0, uv = 0, vv = 0;
    std::array<double, 3> right{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double u = fit.u[i], v = fit.v[i];
        const Vec3 change = normals[(i + 2) % 3] - normals[(i + 1) % 3];
        const double du = change.x(), dv = change.y();
        uu += u * u;
        uv += u * v;
        vv += v * v;
        right[0] += u * du;
        right[1] += v * du + u * dv;
        right[2] += v * dv;
    }
    return solve_tridiagonal<3>({uu, uu + vv, vv}, {uv, uv}, right);
}

/// The same for the derivative, from the change of the vertex forms, given in the face's frame (ibid., Sec. 3).
Derivative fit_derivative(const FaceFit& fit, const std::array<Form, 3>& forms) {
    double uu = 0, uv = 0, vv = 0;
    std::array<double, 4> right{};
    for (std::size_t i = 0; i < 3; ++i) {
        const double u = fit.u[i], v = fit.v[i];
        const Form &to = forms[(i + 2) % 3], &from = forms[(i + 1) % 3];
        const double d11 = to[0] - from[0], d12 = to[1] - from[1], d22 = to[2] - from[2];
        uu += u * u;
        uv += u * v;
        vv += v * v;
        right[0] += u * d11;
        right[1] += v * d11 + 2 * u * d12;
        right[2] += 2 * v * d12 + u * d22;
        right[3] += v * d22;
    }
    return solve_tridiagonal<4>({uu, 2 * uu + vv, uu + 2 * vv, vv}, {uv, 2 * uv, uv}, right);
}

/// Mean of the faces' tensors at each vertex, in the vertex frames, weighted by corner area; zero without faces.
template <typename Tensor>
std::vector<Tensor> average_at_vertices(const TriangleMesh& mesh, const std::vector<FaceFit>& fits,
                                        const std::vector<Tensor>& face_tensors, const std::vector<float>& area) {
    std::vector<Tensor> sums(mesh.vertex_count(), Tensor{});
    for (std::size_t f = 0; f < fits.size(); ++f) {
        if (!fits[f].valid) continue;
        for (std::size_t i = 0; i < 3; ++i) {
            const std::uint32_t vertex = mesh.faces[f][i];
            const Tensor there = turned(face_tensors[f], fits[f].turn[i]);
            const float weight = fits[f].corner_area[i] / area[vertex];
            for (std::size_t k = 0; k < there.size(); ++k) sums[vertex][k] += weight * there[k];
        }
    }
    return sums;
}

std::vector<float> vertex_areas(const TriangleMesh& mesh, const std::vector<FaceFit>& fits) {
    std::vector<float> area(mesh.vertex_count(), 0.0f);
    for (std::size_t f = 0; f < fits.size(); ++f)
        if (fits[f].valid)
            for (std::size_t i = 0; i < 3; ++i) area[mesh.faces[f][i]] += fits[f].corner_area[i];
    return area;
}

/// Some unit vector orthogonal to the unit vector n, without branches but for a sign (Duff et al. 2017).
Vec3 any_tangent(const Vec3& n) {
    const float sign = std::copysign(1.0f, n.z());
    const float a = -1.0f / (sign + n.z());
    return {1 + sign * n.x() * n.x() * a, sign * n.x() * n.y() * a, -sign * n.x()};
}

/// The turn to the principal frame, in which `form` is diagonal with the larger value first.
Turn principal_turn(const Form& form, float& k1, float& k2) {
    const float half_difference = 0.5f * (form[0] - form[2]), mean = 0.5f * (form[0] + form[2]);
    const float radius = std::hypot(half_difference, form[1]);
    k1 = mean + radius;
    k2 = mean - radius;
    if (!(radius > 0)) return {};
    // Half the angle of (half_difference, form[1]), by whichever of the two formulas does not cancel.
    if (half_difference >= 0) {
        const float cosine = std::sqrt(0.5f * (1 + half_difference / radius));
        return {cosine, form[1] / (2 * radius * cosine)};
    }
    const float sine = std::sqrt(0.5f * (1 - half_difference / radius));
    return {form[1] / (2 * radius * sine), sine};
}

/// Measures each face and fits its second fundamental form.
std::vector<Form> fit_faces(const TriangleMesh& mesh, const std::vector<Vec3>& normals,
                            const std::vector<Vec3>& first_axis, std::vector<FaceFit>& fits) {
    std::vector<Form> forms(mesh.face_count());
    parallel_for(
        mesh.face_count(),
        [&](std::size_t f) {
            FaceFrame frame;
            const Face& face = mesh.faces[f];
            fits[f].valid = measure_face(mesh, face, fits[f], frame);
            if (!fits[f].valid) return;
            std::array<Vec3, 3> in_face;
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3& n = normals[face[i]];
                in_face[i] = {frame.tangent.dot(n), frame.bitangent.dot(n), frame.normal.dot(n)};
                fits[f].turn[i] = turn_to_vertex(frame, first_axis[face[i]], in_face[i]);
            }
            forms[f] = fit_form(fits[f], in_face);
        },
        k_grain);
    return forms;
}

/// Turns the vertex frames to the principal ones; returns those turns.
std::vector<Turn> diagonalize(const std::vector<Form>& forms, const std::vector<Vec3>& normals,
                              const std::vector<Vec3>& first_axis, VertexCurvature& curvature) {
    const std::size_t count = forms.size();
    curvature.k1.resize(count);
    curvature.k2.resize(count);
    curvature.e1.resize(count);
    curvature.e2.resize(count);
    std::vector<Turn> turns(count);
    for (std::size_t i = 0; i < count; ++i) {
        turns[i] = principal_turn(forms[i], curvature.k1[i], curvature.k2[i]);
        const Vec3 &u = first_axis[i], v = normals[i].cross(u);
        curvature.e1[i] = turns[i].cosine * u + turns[i].sine * v;
        curvature.e2[i] = turns[i].cosine * v - turns[i].sine * u;
    }
    return turns;
}

/// Fits the derivative of each face from the principal curvatures at its corners. The turns of `fits` must lead to the
/// principal frames.
std::vector<Derivative> fit_derivatives(const TriangleMesh& mesh, const std::vector<FaceFit>& fits,
                                        const VertexCurvature& curvature) {
    std::vector<Derivative> derivatives(mesh.face_count());
    parallel_for(
        mesh.face_count(),
        [&](std::size_t f) {
            if (!fits[f].valid) return;
            std::array<Form, 3> forms;
            for (std::size_t i = 0; i < 3; ++i) {
                const std::uint32_t vertex = mesh.faces[f][i];
                forms[i] = turned(Form{curvature.k1[vertex], 0.0f, curvature.k2[vertex]}, fits[f].turn[i].inverse());
            }
            derivatives[f] = fit_derivative(fits[f], forms);
        },
        k_grain);
    return derivatives;
}

Turn combined(Turn first, Turn second) {
    return {first.cosine * second.cosine - first.sine * second.sine,
            first.sine * second.cosine + first.cosine * second.sine};
}

}  // namespace

VertexCurvature estimate_curvature(const TriangleMesh& mesh, bool with_derivatives) {
    const std::vector<Vec3> normals = vertex_normals(mesh);
    std::vector<Vec3> first_axis;
    first_axis.reserve(normals.size());
    for (const Vec3& n : normals) first_axis.push_back(any_tangent(n));

    std::vector<FaceFit> fits(mesh.face_count());
    const std::vector<Form> face_forms = fit_faces(mesh, normals, first_axis, fits);
    const std::vector<float> area = vertex_areas(mesh, fits);
    const std::vector<Form> forms = average_at_vertices(mesh, fits, face_forms, area);

    VertexCurvature curvature;
    const std::vector<Turn> turns = diagonalize(forms, normals, first_axis, curvature);
    if (!with_derivatives) return curvature;
    for (std::size_t f = 0; f < fits.size(); ++f)
        for (std::size_t i = 0; i < 3; ++i) fits[f].turn[i] = combined(fits[f].turn[i], turns[mesh.faces[f][i]]);
    curvature.derivative = average_at_vertices(mesh, fits, fit_derivatives(mesh, fits, curvature), area);
    return curvature;
}

}  // namespace exemplar
