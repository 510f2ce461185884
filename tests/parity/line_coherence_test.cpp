#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "gpu/lines/line_renderer.h"
#include "host/lines/strokes/coherence.h"
#include "host/lines/strokes/strokes.h"
#include "tests/parity/line_scene.h"

namespace exemplar {
namespace {

using namespace test_support;

constexpr float k_period = shared::k_texture_width;

/// A surface that turns and swells, seen by a camera that stands still.
struct Motion {
    Scene scene{mixed()};
    std::vector<Vec3> rest = scene.mesh.vertices;
    LineRenderer renderer{shared_device(), scene.line_surface};
    Stream stream{shared_device()};
    LinePicture picture;

    explicit Motion(std::vector<LineType> types) {
        LineThresholds thresholds;
        thresholds.principal_highlights = 0.001f;  // so that there are some
        picture.view = {.camera = fit_camera(scene.mesh, Vec3(3.07f, 2.11f, 4.23f), picture_aspect()),
                        .width = picture_width(),
                        .height = picture_height(),
                        .unit_depth = 20,
                        .feature_size = scene.size()};
        picture.families = line_families(types);
        picture.thresholds = family_thresholds(thresholds);
        picture.looks = plain_looks(thresholds, {.taper = 0});
    }
    void draw(int frame) {
        const Eigen::AngleAxisf turn(0.03f * static_cast<float>(frame), Vec3(0.2f, 1, 0.1f).normalized());
        std::vector<Vec3> vertices = rest;
        for (Vec3& v : vertices) v = turn * v + 0.02f * std::sin(static_cast<float>(frame) + v.y()) * v;
        scene.move(std::move(vertices));
        renderer.render(stream, scene.snapshot(), picture);
    }
    Found found() const {
        Found result{};
        const GpuLineExtraction& lines = renderer.strokes().chains().lines();
        lines.counts().download(std::span(&result.counts, 1));
        result.segments.resize(result.counts.segments);
        lines.segments().download(std::span(result.segments));
        return result;
    }
    /// Four floats per segment.
    std::vector<vec4> traces(std::size_t segments) const {
        std::vector<vec4> result(segments);
        renderer.coherence().traces().download(std::span(result));
        return result;
    }
};

std::vector<LineTrace> as_traces(const std::vector<LineSegment>& segments, const std::vector<vec4>& traces) {
    std::vector<LineTrace> result;
    for (std::size_t i = 0; i < segments.size(); ++i)
        result.push_back({segments[i].face, segments[i].family, segments[i].ends, {traces[i].x, traces[i].y}});
    return result;
}

/// How far coordinates of a texture are apart, around its period.
float apart(float a, float b) {
    const float turns = (a - b) / k_period;
    return k_period * std::abs(turns - std::round(turns));
}

class CoherenceParity : public ::testing::TestWithParam<LineType> {};

TEST_P(CoherenceParity, TexturesLieWhereTheReferenceLaysThem) {
    Motion motion({GetParam()});
    std::vector<LineTrace> before;
    std::size_t pieces = 0, off = 0;
    for (int frame = 0; frame < 4; ++frame) {
        motion.draw(frame);
        const Found found = motion.found();
        const std::vector<LineSegment> segments = segments_of_type(found.segments, GetParam()).segments;
        const std::vector<vec4> actual = motion.traces(segments.size());
        const LineSurface surface = motion.scene.surface();
        const std::vector<Chain> chains = chain_segments(surface.faces, surface.neighbors, segments);
        const auto textures = follow_traces(surface, segments, chains, before, motion.picture.view, k_period);
        const auto expected = trace_lines(surface, segments, chains, textures, motion.picture.view, k_period);
        for (std::size_t i = 0; i < segments.size(); ++i) {
            ++pieces;
            // A line that was equally near to two others may follow either.
            if (apart(expected[i].texture[0], actual[i].x) > 0.5f || apart(expected[i].texture[1], actual[i].y) > 0.5f)
                ++off;
        }
        before = as_traces(segments, actual);
    }
    EXPECT_GT(pieces, 40u);
    EXPECT_LE(off, pieces / 50);
}

INSTANTIATE_TEST_SUITE_P(AllTypes, CoherenceParity, ::testing::ValuesIn(k_line_types),
                         [](const auto& type) { return std::string(name_of(type.param)); });

TEST(Coherence, WhatStandsStillDoesNotFlicker) {
    Motion motion({k_line_types.begin(), k_line_types.end()});
    motion.draw(0);
    EXPECT_FLOAT_EQ(motion.renderer.coherence().flicker().appeared, 1);
    for (int i = 0; i < 3; ++i) motion.draw(0);
    const LineFlicker flicker = motion.renderer.coherence().flicker();
    EXPECT_GT(flicker.drawn, 1000);
    EXPECT_EQ(flicker.appeared, 0);
    EXPECT_LT(flicker.slip, 0.1f);
}

/// The mean slip over some frames in motion.
float slip_in_motion(bool coherent) {
    Motion motion({LineType::contours, LineType::suggestive_contours, LineType::ridges});
    motion.picture.coherent = coherent;
    motion.draw(0);
    float slip = 0;
    for (int frame = 1; frame <= 8; ++frame) {
        motion.draw(frame);
        slip += motion.renderer.coherence().flicker().slip / 8;
        EXPECT_LT(motion.renderer.coherence().flicker().appeared, 0.2f);
    }
    return slip;
}

TEST(Coherence, TexturesStayOnLinesThatMove) {
    const float kept = slip_in_motion(true), anew = slip_in_motion(false);
    EXPECT_LT(kept, 3);
    EXPECT_LT(kept, 0.25f * anew);
}

TEST(Coherence, RerunsLayTexturesAlike) {
    const auto third_frame = [] {
        Motion motion({k_line_types.begin(), k_line_types.end()});
        for (int frame = 0; frame < 3; ++frame) motion.draw(frame);
        return motion.traces(motion.found().segments.size());
    };
    const std::vector<vec4> once = third_frame(), again = third_frame();
    ASSERT_EQ(once.size(), again.size());
    EXPECT_EQ(0, std::memcmp(once.data(), again.data(), once.size() * sizeof(vec4)));
}

}  // namespace
}  // namespace exemplar
