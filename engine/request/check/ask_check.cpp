#include "engine/request/check/ask_check.h"

#include <mutex>
#include <optional>

namespace tunewright {
namespace {

/// Counts the loops that are done; its calls come from several threads.
class LoopsProgress {
public:
    LoopsProgress(const RunControl& control, std::size_t loops) : control_(control), loops_(loops) {}

    void one_done() {
        const std::scoped_lock lock(mutex_);
        ++done_;
        if (!control_.progress) return;
        Progress progress;
        progress.fraction = static_cast<double>(done_) / static_cast<double>(loops_);
        progress.stage = "check";
        progress.message = std::to_string(done_) + " of " + std::to_string(loops_) + " loops checked.";
        control_.progress(progress);
    }

private:
    const RunControl& control_;
    std::size_t loops_, done_ = 0;
    std::mutex mutex_;
};

}  // namespace

check::PlantCheck judged_together(std::vector<CheckedLoop>& loops, bool cluster) {
    std::vector<check::LoopCheck*> all;
    for (CheckedLoop& loop : loops) all.push_back(&loop);
    check::PlantCheck plant = check::check_plant(all, cluster);
    for (CheckedLoop& loop : loops)
        if (loop.cure && loop.action.code == check::ActionCode::find_source) loop.cure.reset();
    return plant;
}

Expected<CheckResult> ask_check(const CheckQuestion& question, const RunControl& control) {
    const std::size_t n = question.loops.size();
    std::vector<std::optional<CheckedLoop>> done(n);
    LoopsProgress progress(control, n);
    parallel_for(control.spread, static_cast<int>(n), [&](int i) {
        const auto at = static_cast<std::size_t>(i);
        if (control.stop.stop_requested()) return;
        auto found = check::check_loop(question.loops[at], control.stop);
        if (!found) {
            if (found.error().kind != ErrorKind::cancelled)
                done[at].emplace(
                    CheckedLoop{check::unreadable_loop(question.loops[at].tag, found.error().message), {}});
        } else {
            CheckedLoop loop{std::move(*found), {}};
            if (question.settings) loop.cure = cure_of(question.loops[at], loop, control);
            // A stop during the cure leaves the loop as one that was not reached.
            if (!question.settings || !control.stop.stop_requested()) done[at].emplace(std::move(loop));
        }
        progress.one_done();
    });
    CheckResult result;
    std::size_t reached = 0;
    for (std::size_t i = 0; i < n; ++i) {
        reached += done[i] ? 1 : 0;
        result.loops.push_back(
            done[i] ? std::move(*done[i])
                    : CheckedLoop{check::unreadable_loop(question.loops[i].tag,
                                                         "The check was stopped before this loop was reached."),
                                  {}});
    }
    if (reached == 0 && n > 0) return Error{ErrorKind::cancelled, "", "The check was stopped."};
    result.partial = reached < n;
    result.plant = judged_together(result.loops, question.cluster);
    return result;
}

}  // namespace tunewright
