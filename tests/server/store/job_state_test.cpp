
#include <gtest/gtest.h>

#include <array>
#include <tuple>

#include "server/store/job_state.h"

namespace tunewright::server {
namespace {

constexpr std::array kStates{JobStatus::queued, JobStatus::running, JobStatus::succeeded, JobStatus::failed,
                             JobStatus::cancelled};
constexpr std::array kEvents{JobEvent::claim,  JobEvent::succeed, JobEvent::fail,
                             JobEvent::cancel, JobEvent::release, JobEvent::requeue};

TEST(JobState, TheWaysBetweenStatesAreExactlyTheDocumentedOnes) {
    using S = JobStatus;
    using E = JobEvent;
    const std::array<std::tuple<S, E, S>, 8> ways{{{S::queued, E::claim, S::running},
                                                   {S::queued, E::cancel, S::cancelled},
                                                   {S::running, E::succeed, S::succeeded},
                                                   {S::running, E::fail, S::failed},
                                                   {S::running, E::cancel, S::cancelled},
                                                   {S::running, E::release, S::queued},
                                                   {S::failed, E::requeue, S::queued},
                                                   {S::cancelled, E::requeue, S::queued}}};
    for (const S from : kStates) {
        for (const E event : kEvents) {
            std::optional<S> expected;
            for (const auto& [a, by, b] : ways)
                if (a == from && by == event) expected = b;
            EXPECT_EQ(transition(from, event), expected) << to_string(from) << " by " << static_cast<int>(event);
        }
    }
}

TEST(JobState, AnEndedJobIsMovedOnlyWhereItsOwnerHasItQueuedAgain) {
    for (const JobStatus state : kStates) {
        if (!has_ended(state)) continue;
        for (const JobEvent event : kEvents) EXPECT_TRUE(event == JobEvent::requeue || !transition(state, event));
    }
    EXPECT_FALSE(transition(JobStatus::succeeded, JobEvent::requeue)) << "there is nothing to be tried again";
}

TEST(JobState, NamesReadBackAsTheirStates) {
    for (const JobStatus state : kStates) EXPECT_EQ(job_status(to_string(state)), state);
    EXPECT_FALSE(job_status("done"));
    EXPECT_FALSE(job_status(""));
}

}  // namespace
}  // namespace tunewright::server
