// Draws an animated figure with a Vulkan renderer of one's own (renderer.h), and lets Exemplar draw feature lines by
// learned curvature over its pictures: on the same device, in the same command buffers.
//
//   embed_lines FIGURE.glb MODEL.safetensors                            a window
//   embed_lines FIGURE.glb MODEL.safetensors --out FOLDER [--frames N]  pictures
//
// --size WxH: of the pictures; --white draws the figure white; --validate loads the validation layer.

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <optional>
#include <string>

#include "gpu/lines/animation_renderer.h"
#include "gpu/lines/device_style.h"
#include "host/animation/read_animation.h"
#include "host/curvature/model/model.h"
#include "host/imaging/png.h"
#include "host/lines/strokes/view_point.h"
#include "host/mesh/mesh.h"
#include "renderer.h"

namespace {

struct Arguments {
    std::string figure, model, out;
    VkExtent2D size{1000, 800};
    std::uint64_t frames = 0;  // 0: all, or in a window without end
    bool white = false, validate = false;
};

Arguments parse(int count, char** words) {
    Arguments arguments;
    std::vector<std::string> files;
    for (int i = 1; i < count; ++i) {
        const std::string word = words[i];
        if (word == "--white")
            arguments.white = true;
        else if (word == "--validate")
            arguments.validate = true;
        else if (word == "--out" && i + 1 < count)
            arguments.out = words[++i];
        else if (word == "--size" && i + 1 < count)
            std::sscanf(words[++i], "%ux%u", &arguments.size.width, &arguments.size.height);
        else if (word == "--frames" && i + 1 < count)
            arguments.frames = std::strtoull(words[++i], nullptr, 10);
        else
            files.push_back(word);
    }
    if (files.size() != 2)
        throw std::runtime_error(
            "usage: embed_lines FIGURE.glb MODEL.safetensors [--out FOLDER] [--frames N] [--size WxH]");
    arguments.figure = files[0];
    arguments.model = files[1];
    return arguments;
}

// The figure, the view of it and everything that Exemplar needs to draw its lines.
class Lines {
  public:
    Lines(const Renderer& renderer, const exemplar::Animation& animation, const exemplar::CurvatureModel& model,
          const exemplar::StrokeView& view)
        : device_({.instance = renderer.instance,
                   .physical = renderer.physical,
                   .device = renderer.device,
                   .queue = renderer.queue,
                   .queue_family = renderer.family,
                   .features12 = renderer.features12,
                   .features13 = renderer.features13}),
          surface_(device_, animation, model.truth, &model) {
        const exemplar::DeviceStyle style = exemplar::device_style(exemplar::load_style("ink"));
        surface_.view().set_textures(style.textures);
        picture_.view = view;
        const std::array types{exemplar::LineType::contours, exemplar::LineType::suggestive_contours};
        exemplar::apply_style(style, types, picture_);
        for (std::optional<exemplar::Stream>& stream : streams_) stream.emplace(device_);
    }

    // Records the lines of a frame over its picture. The stream of the frame keeps what the device needs until its next
    // turn.
    void record(std::uint64_t number, exemplar::FrameRef at, const Frame& frame) {
        exemplar::Stream& stream = *streams_[number % streams_.size()];
        stream.retire();
        stream.record_into(frame.commands);
        surface_.record(stream, at, exemplar::CurvatureSource::learned);
        surface_.view().record_over(stream, surface_.snapshot(), picture_,
                                    {.color = frame.color.view, .format = k_color_format});
        stream.end_recording();
    }

    // To be called once the device has finished all frames.
    void retire() {
        for (std::optional<exemplar::Stream>& stream : streams_) stream->retire();
    }

  private:
    exemplar::Device device_;
    exemplar::AnimationRenderer surface_;
    exemplar::LinePicture picture_;
    std::array<std::optional<exemplar::Stream>, k_frames_in_flight> streams_;
};

std::vector<Vertex> vertices_of_frame(const exemplar::Animation& animation, exemplar::FrameRef at) {
    exemplar::TriangleMesh mesh = animation.rest;
    mesh.vertices = exemplar::frame_vertices(animation, animation.clips[at.clip], at.frame);
    const std::vector<exemplar::Vec3> normals = exemplar::vertex_normals(mesh);
    std::vector<Vertex> vertices(mesh.vertices.size());
    for (std::size_t v = 0; v < vertices.size(); ++v)
        for (int axis = 0; axis < 3; ++axis) {
            vertices[v].position[axis] = mesh.vertices[v][axis];
            vertices[v].normal[axis] = normals[v][axis];
        }
    return vertices;
}

// A view in which the figure fits when it is in its first frame.
exemplar::StrokeView view_of(const exemplar::Animation& animation, const exemplar::CurvatureModel& model,
                             VkExtent2D size) {
    exemplar::TriangleMesh first = animation.rest;
    first.vertices = exemplar::frame_vertices(animation, animation.clips[0], 0);
    exemplar::ViewPoint point;
    point.view = "front";
    point.width = static_cast<int>(size.width);
    point.height = static_cast<int>(size.height);
    return exemplar::stroke_view(point, first, model.feature_size);
}

void write_picture(const Frame& frame, VkExtent2D size, const std::filesystem::path& path) {
    exemplar::Image image(static_cast<int>(size.width), static_cast<int>(size.height), 3);
    for (std::size_t i = 0; i < image.data.size() / 3; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            image.data[3 * i + c] = std::to_integer<std::uint8_t>(frame.pixels.mapped[4 * i + c]);
    exemplar::write_png(path, image);
}

int run(const Arguments& arguments, GLFWwindow* window) {
    const exemplar::Animation animation = exemplar::read_animation(arguments.figure);
    const exemplar::CurvatureModel model = exemplar::load_curvature_model(arguments.model);
    const exemplar::StrokeView view = view_of(animation, model, arguments.size);
    const std::vector<std::uint32_t> indices = [&] {
        std::vector<std::uint32_t> corners;
        for (const exemplar::Face& face : animation.rest.faces) corners.insert(corners.end(), face.begin(), face.end());
        return corners;
    }();
    Renderer renderer(window, arguments.size, arguments.validate, indices, animation.rest.vertices.size());
    {
        Lines lines(renderer, animation, model, view);
        const std::size_t size = animation.clips[0].size();
        const std::uint64_t frames = arguments.frames || window ? arguments.frames : size;
        const Eigen::Matrix4f clip_from_mesh = view.camera.view_projection();
        for (std::uint64_t number = 0; number < frames || frames == 0; ++number) {
#ifdef HAS_WINDOW
            if (window) glfwPollEvents();
            if (window && glfwWindowShouldClose(window)) break;
#endif
            const exemplar::FrameRef at{0, static_cast<std::uint32_t>(number % size)};
            Frame& frame = renderer.begin(number);
            renderer.draw_figure(frame, vertices_of_frame(animation, at), clip_from_mesh.data(),
                                 arguments.white ? 0.0f : 0.6f);
            lines.record(number, at, frame);
            renderer.end(frame);
            if (window) continue;
            renderer.wait(frame);
            write_picture(frame, arguments.size,
                          std::filesystem::path(arguments.out) / ("frame_" + std::to_string(number) + ".png"));
        }
        vkQueueWaitIdle(renderer.queue);
        lines.retire();
    }
    return renderer.messages() == 0 ? 0 : 1;
}

}  // namespace

int main(int count, char** words) try {
    const Arguments arguments = parse(count, words);
    if (!arguments.out.empty()) {
        std::filesystem::create_directories(arguments.out);
        return run(arguments, nullptr);
    }
#ifdef HAS_WINDOW
    if (!glfwInit()) throw std::runtime_error("there is no display; write pictures with --out FOLDER");
    glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
    glfwWindowHint(GLFW_RESIZABLE, GLFW_FALSE);
    GLFWwindow* window =
        glfwCreateWindow(static_cast<int>(arguments.size.width), static_cast<int>(arguments.size.height),
                         "Lines by Exemplar", nullptr, nullptr);
    const int result = run(arguments, window);
    glfwDestroyWindow(window);
    glfwTerminate();
    return result;
#else
    throw std::runtime_error("built without GLFW: write pictures with --out FOLDER");
#endif
} catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << "\n";
    return 1;
}
