#pragma once

#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "gpu/imaging/canvas.h"
#include "gpu/imaging/surface_painter.h"
#include "gpu/lines/chains.h"
#include "gpu/lines/coherence.h"
#include "gpu/lines/extraction.h"
#include "gpu/lines/strokes.h"
#include "gpu/runtime/kernels/draw_pipeline.h"
#include "gpu/runtime/record/stream.h"
#include "host/imaging/image.h"
#include "host/mesh/labels.h"

namespace exemplar {

/// View, line types and style of one line drawing.
struct LinePicture {
    StrokeView view;
    std::uint32_t families = 0;  ///< line_families() of the types to draw; 0: the surface alone
    FamilyThresholds thresholds{};
    StrokeLooks looks{};
    bool coherent = true;  ///< textures stay where they were in the previous picture
    PaintLook surface{.light = SurfaceLight::none, .plain = {255, 255, 255}};
};

/// An image of the caller's that strokes are drawn over, in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL.
struct StrokeTarget {
    VkImageView color = VK_NULL_HANDLE;
    VkFormat format =
        VK_FORMAT_UNDEFINED;  ///< of 8-bit UNORM or 16-bit float colors; they are blended as they are stored
};

/// Renders line drawings of a surface entirely on the device, from buffers of its vertices, normals and curvature to
/// an image: extraction, chains, the surface with its depths, visibility, strokes.
class LineRenderer {
  public:
    /// `surface` must live as long as this. Throws DeviceError if the device cannot draw.
    LineRenderer(Device& device, const GpuLineSurface& surface);

    /// Sets one color per face, for SurfacePaint::faces. Throws UsageError for another number.
    void set_face_colors(std::span<const Color> colors);
    /// Sets the inks of the faces; empty ones: all are drawn as LinePicture::looks says. Throws as GpuPartInks.
    void set_part_inks(const PartInks& inks);
    /// Sets the textures that StrokeLook refers to: opacities of shared::k_texture_width x k_texture_height texels,
    /// row by row, one texture after the other. Throws UsageError if they are not whole textures.
    void set_textures(std::span<const std::uint8_t> opacities);

    /// Records a picture into canvas(), 8-bit RGBA, of the size of the view. Throws DeviceLimitError if the surface
    /// is too large for the device to find lines on, UsageError as GpuLineExtraction does or for an empty picture.
    void record(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture);
    /// Records the strokes of a picture over an image of the caller's of the size of the view; the surface only hides
    /// lines. `picture.surface` does not matter. Throws as record().
    void record_over(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture,
                     const StrokeTarget& target);
    Canvas& canvas() { return canvas_; }

    /// Records, runs and downloads a picture: RGB, or RGBA if its background is transparent.
    Image render(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture);
    /// Records the download of the image; after finish(), read_image() has it.
    void record_download(Stream& stream) { canvas_.record_download(stream); }
    Image read_image() const { return canvas_.read_image(transparent_); }

    /// Data of the lines. May only be called after a picture with families.
    const GpuStrokes& strokes() const { return lines_->strokes; }
    const GpuCoherence& coherence() const { return lines_->coherence; }

  private:
    void resize(int width, int height);
    void draw_surface(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture);
    void record_strokes(Stream& stream, const GpuCurvedSurface& snapshot, const LinePicture& picture);
    void draw_strokes(Stream& stream, const LinePicture& picture, const StrokeTarget& target);
    Device& device_;
    const GpuLineSurface& surface_;
    /// The stages from surface to strokes. Members refer to each other, so it must not move.
    struct Lines {
        GpuLineExtraction extraction;
        GpuChains chains;
        GpuStrokes strokes;
        GpuCoherence coherence;
        std::map<VkFormat, DrawPipeline> pipelines;  // by the format of the image

        Lines(Device& device, const GpuLineSurface& surface);
    };
    std::optional<Lines> lines_;  // made for the first picture with families
    Canvas canvas_;
    SurfacePainter painter_;
    bool transparent_ = false;
    Buffer depths_, face_colors_, textures_;
    std::optional<GpuPartInks> inks_;
};

}  // namespace exemplar
