#pragma once

#include <array>
#include <cstddef>
#include <span>

#include "host/mesh/mesh.h"

namespace exemplar {

/// Real spherical harmonics of the bands 0 to 4.
constexpr std::size_t k_harmonic_bands = 5, k_harmonics = k_harmonic_bands * k_harmonic_bands;
using Harmonics = std::array<float, k_harmonics>;

/// Evaluates the harmonics at a unit direction, orthonormal over the sphere; Y_lm is coefficient l (l + 1) + m.
Harmonics spherical_harmonics(const Vec3& direction);

/// Returns the coefficients of a distant light from a unit direction: a delta function through a Hann window, so
/// that the light does not ring (Sloan 2008). A surface that faces the light has a brightness of about 1.
Harmonics distant_light(const Vec3& direction);

/// Returns the sum of products: the integral over the sphere of the product of both functions.
float dot(std::span<const float, k_harmonics> first, std::span<const float, k_harmonics> second);

/// Returns `count` directions, evenly spread over the sphere (a Fibonacci spiral).
std::vector<Vec3> sphere_directions(std::size_t count);

}  // namespace exemplar
