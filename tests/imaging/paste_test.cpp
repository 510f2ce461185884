#include "host/imaging/paste.h"

#include <gtest/gtest.h>

#include "host/core/errors.h"

namespace exemplar {
namespace {

TEST(Paste, ChangesThePixelsOfThePartAndNoOthers) {
    Image image(5, 4, 3, 7), part(2, 3, 3);
    for (std::size_t i = 0; i < part.data.size(); ++i) part.data[i] = static_cast<std::uint8_t>(100 + i);
    paste(part, 3, 1, image);
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 5; ++x)
            for (std::size_t c = 0; c < 3; ++c) {
                const bool inside = x >= 3 && y >= 1;
                EXPECT_EQ(image.pixel(x, y)[c], inside ? part.pixel(x - 3, y - 1)[c] : 7) << x << ' ' << y;
            }
}

TEST(Paste, RefusesWhatDoesNotFit) {
    Image image(5, 4, 3);
    EXPECT_THROW(paste(Image(2, 2, 3), 4, 0, image), UsageError);
    EXPECT_THROW(paste(Image(2, 2, 3), 0, 3, image), UsageError);
    EXPECT_THROW(paste(Image(2, 2, 3), -1, 0, image), UsageError);
    EXPECT_THROW(paste(Image(2, 2, 4), 0, 0, image), UsageError);
    EXPECT_NO_THROW(paste(Image(0, 0, 3), 5, 4, image));
}

}  // namespace
}  // namespace exemplar
