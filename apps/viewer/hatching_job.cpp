#include "apps/viewer/hatching_job.h"

#include <utility>

#include "host/core/cancel.h"
#include "host/core/interrupt.h"

namespace exemplar {

HatchingJob::HatchingJob(HatchedStill still, std::vector<std::filesystem::path> files) {
    result_ = std::async(std::launch::async,
                         [this, still = std::move(still), files = std::move(files)] { return run(still, files); });
}

HatchingJob::~HatchingJob() {
    cancel();
    if (result_.valid()) result_.wait();
}

std::vector<std::filesystem::path> HatchingJob::run(const HatchedStill& still,
                                                    const std::vector<std::filesystem::path>& files) {
    const auto step = [this](const char* what) {
        check_interrupt();
        what_ = what;
    };
    run_cancelable(canceled_, [&] {
        const HatchedDrawing drawing = draw_still(still, step);
        step("saving");
        for (const std::filesystem::path& file : files) write_still(file, still, drawing);
    });
    return files;
}

HatchingJob::Status HatchingJob::status() const {
    return {what_, std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count()};
}

bool HatchingJob::finished() const {
    return result_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace exemplar
