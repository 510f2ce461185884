#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/report/report_page.h"

namespace exemplar {

/// The line drawing of the demo.
struct DemoLines {
    ReportDrawing drawing;
    nlohmann::json report;
};

/// Learns the curvature of a generated figure from part of its motion, and draws unseen frames by learned and by
/// measured curvature. Writes the animation, the model and the drawing to `folder`.
DemoLines make_demo_lines(const std::filesystem::path& folder, std::uint64_t seed);

}  // namespace exemplar
