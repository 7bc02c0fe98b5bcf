// Which gains a controller's times leave: the union of all intervals of |Kp| that some frequency forbids (Garpinger and
// Hagglund 2008, Eq. 6), joined and sorted.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

namespace tunewright::robust {

/// Gains between which no frequency forbids anything; upper is infinite for the last gap.
struct GainGap {
    double lower = 0, upper = 0;
    /// Whether the loop is stable inside, on every plant, by what the grid tells of the encirclements of -1. Empty: it
    /// does not tell.
    std::optional<bool> stable = std::nullopt;
    /// It is, for certain: a stable plant at low gain.
    bool proved = false;

    /// A gain inside; finite gaps only.
    double middle() const;
};

/// Joins the intervals of neighbouring frequencies, which nearly always overlap, before they are sorted with others.
class JoinedIntervals {
public:
    explicit JoinedIntervals(std::vector<GainGap>& out) : out_(out) {}
    ~JoinedIntervals() { close(); }
    JoinedIntervals(const JoinedIntervals&) = delete;
    JoinedIntervals& operator=(const JoinedIntervals&) = delete;

    void add(double lower, double upper) {
        if (open_ && lower <= joined_.upper && upper >= joined_.lower) {
            if (lower < joined_.lower) joined_.lower = lower;
            if (upper > joined_.upper) joined_.upper = upper;
            return;
        }
        close();
        joined_ = {.lower = lower, .upper = upper};
        open_ = true;
    }

private:
    void close() {
        if (open_) out_.push_back(joined_);
    }

    std::vector<GainGap>& out_;
    GainGap joined_;
    bool open_ = false;
};

/// What the forbidden intervals leave, in ascending order. `forbidden` is sorted on the way.
std::vector<GainGap> gaps_between(std::vector<GainGap>& forbidden);

}  // namespace tunewright::robust
