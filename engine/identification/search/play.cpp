#include "engine/identification/search/play.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "engine/identification/record/series.h"
#include "engine/identification/search/candidates.h"
#include "engine/numerics/matrix/dense.h"

namespace tunewright {
namespace {

/// The direction of the first move of u: 1 or -1.
double first_direction(const std::vector<double>& levels) { return levels.front() < 0 ? -1 : 1; }

/// The positions behind the play: a move further than the play follows takes the position along.
std::vector<double> positions_of(const std::vector<double>& levels, const Play& play) {
    const double ahead = play.width * play.ahead, behind = play.width - ahead, direction = first_direction(levels);
    std::vector<double> positions;
    positions.reserve(levels.size());
    double position = 0;
    for (const double level : levels) {
        const double moved = direction * level;
        position = std::clamp(position, moved - ahead, moved + behind);
        positions.push_back(direction * position);
    }
    return positions;
}

CleanRecord with(const CleanRecord& record, const Play& play) {
    CleanRecord moved = record;
    moved.play = play;
    moved.v_recorded = record.v_level;
    moved.v_level = positions_of(record.v_level, play);
    return moved;
}

double swing(const std::vector<double>& levels) {
    const auto [low, high] = std::ranges::minmax(levels);
    return std::max(high, 0.0) - std::min(low, 0.0);
}

/// True if u returns to a level, to `near`, at a position that is `apart` from the one before.
bool returns_apart(std::vector<double> levels, std::vector<double> positions, double near, double apart) {
    levels.push_back(0), positions.push_back(0);  // at first
    for (std::size_t i = 0; i < levels.size(); ++i)
        for (std::size_t j = i + 1; j < levels.size(); ++j)
            if (std::abs(levels[i] - levels[j]) <= near && std::abs(positions[i] - positions[j]) >= apart) return true;
    return false;
}

/// True if at one level of u there are two positions: a gain that varies with the level has only one.
bool shows_hysteresis(const std::vector<double>& levels, const Play& play) {
    constexpr double kSameLevel = 0.1, kApart = 0.5;  // of the width
    return returns_apart(levels, positions_of(levels, play), kSameLevel * play.width, kApart * play.width);
}

/// False if u returns to no level, so that no play shows.
bool returns(const std::vector<double>& levels) {
    return returns_apart(levels, std::vector<double>(levels.size(), 0), 0.1 * swing(levels), 0);
}

/// The search over width and share of the play, and the model's shape.
class PlayFit {
public:
    PlayFit(const CleanRecord& record, const Fit& fit, const std::stop_token& stop)
        : record_(every_few(record, kMediumSamples)), fit_(fit), swing_(swing(record.v_level)), stop_(stop) {
        fit_.form.load = fit_.form.slope = false;
    }

    /// `open`: how far the play lies in the way of the first move is searched too.
    Play run(bool open) {
        fit_ = project({&record_, {}}, fit_.form, fit_.shape);
        scan(open);
        descend(open);
        return best_;
    }

    const Fit& fit() const { return fit_; }

private:
    /// With the shape as it is, or fitted anew from it.
    bool take(const Play& play, int iterations) {
        if (play.width < 0 || play.width > swing_ || play.ahead < 0 || play.ahead > 1) return false;
        const CleanRecord moved = with(record_, play);
        constexpr double kTolerance = 1e-6;  // of the sum of squares
        Fit there = iterations == 0 ? project({&moved, {}}, fit_.form, fit_.shape)
                                    : fit_shape({&moved, {}}, fit_.form, fit_.shape, {iterations, kTolerance}, stop_);
        if (!there.determined || !(there.sse < fit_.sse)) return false;
        best_ = play, fit_ = std::move(there);
        return true;
    }
    void scan(bool open) {
        constexpr int kWidths = 24, kShares = 3;
        for (int i = 1; i < kWidths && !stop_.stop_requested(); ++i)
            for (int k = 0; k <= (open ? kShares : 0); ++k)
                take({swing_ * i / kWidths, static_cast<double>(k) / kShares}, 0);
    }
    /// Halves its steps where none of them is better.
    void descend(bool open) {
        constexpr double kFirst = 1.0 / 32, kLast = 1e-5;  // of the swing, and of the width
        constexpr int kIterations = 4, kMaxSteps = 60;
        double step = kFirst;
        for (int i = 0; i < kMaxSteps && step > kLast && !stop_.stop_requested(); ++i) {
            bool better = false;
            for (const double sign : {1.0, -1.0}) {
                better |= take({best_.width + sign * step * swing_, best_.ahead}, kIterations);
                if (open) better |= take({best_.width, best_.ahead + sign * step}, kIterations);
            }
            if (!better) step /= 2;
        }
    }

    const CleanRecord record_;
    Fit fit_;
    const double swing_;
    const std::stop_token& stop_;
    Play best_;
};

/// The part that the columns N have in the Gauss-Newton step of the model and them.
Eigen::VectorXd step_with_model(const Fit& fit, const Eigen::MatrixXd& N) {
    const Eigen::MatrixXd J = sample_rows(fit);
    Eigen::MatrixXd all(N.rows(), J.cols() + N.cols());
    all << J, N;
    return least_squares(all, Eigen::Map<const Eigen::VectorXd>(fit.residual.data(), N.rows())).tail(N.cols());
}

/// The play's width, and with `open` its share ahead, for all samples: Gauss-Newton on them together with the model,
/// from values that are nearly right.
Play refined(const CleanRecord& record, Play play, const Fit& start, bool open, const std::stop_token& stop) {
    constexpr int kRounds = 3;
    constexpr Effort kEffort{4, 1e-6};
    Fit fit = start;
    double min = std::numeric_limits<double>::max();
    Play best = play;
    for (int round = 0; round <= kRounds && !stop.stop_requested(); ++round) {
        const CleanRecord moved = with(record, play);
        fit = fit_shape({&moved, {}}, fit.form, fit.shape, kEffort, stop);
        if (!fit.determined || !(fit.sse < min)) break;
        min = fit.sse, best = play;
        jacobian({&moved, {}}, fit);
        const Eigen::MatrixXd N = play_unknowns(moved, fit).slopes.leftCols(open ? 2 : 1);
        const Eigen::VectorXd step = step_with_model(fit, N);
        const double width = std::clamp(play.width + step[0], 0.5 * play.width, 2 * play.width);
        const double ahead = play.ahead * play.width + (open ? step[1] : 0);
        play = {width, std::clamp(ahead / width, 0.0, 1.0)};
    }
    return best;
}

}  // namespace

std::optional<CleanRecord> with_play(const CleanRecord& record, const Fit& fit, const std::stop_token& stop) {
    constexpr int kMaxMoves = 100;
    constexpr double kMinWidth = 0.01;      // of the range of u
    constexpr double kStrongEvidence = 10;  // of the criterion (Kass and Raftery 1995, section 3.2)
    if (record.play || record.changes() > kMaxMoves || !record.d.empty() || !returns(record.v_level))
        return std::nullopt;
    PlayFit engaged(record, fit, stop), open(record, fit, stop);
    const Play closed = engaged.run(false), free = open.run(true);
    const double n = effective_samples(engaged.fit().residual);
    const bool ahead = n * std::log(engaged.fit().sse / std::max(open.fit().sse, kVarianceFloor)) > kStrongEvidence;
    const Play found = ahead ? free : closed;
    if (stop.stop_requested() || found.width < kMinWidth * swing(record.v_level)) return std::nullopt;
    const Play play = refined(record, found, (ahead ? open : engaged).fit(), ahead, stop);
    return shows_hysteresis(record.v_level, play) ? std::optional(with(record, play)) : std::nullopt;
}

InputUnknowns play_unknowns(const CleanRecord& record, const Fit& fit) {
    if (!record.play) return {};
    constexpr double kDifference = 1e-4;  // of the range of u: positions are linear in both between their kinks
    const Play at = *record.play;
    const double step = std::min(kDifference, 0.1 * at.width);
    // The part ahead as a width, while the part behind is `width` less that.
    const auto positions = [&](double width, double ahead) {
        return positions_of(record.v_recorded, {width, std::clamp(ahead / width, 0.0, 1.0)});
    };
    const double ahead = at.width * at.ahead, low = std::max(0.0, ahead - step),
                 high = std::min(at.width, ahead + step);
    const std::array ends = {std::array{positions(at.width - step, ahead), positions(at.width + step, ahead)},
                             std::array{positions(at.width, low), positions(at.width, high)}};
    const std::array spans = {2 * step, high - low};
    InputUnknowns unknowns;
    unknowns.slopes.resize(record.samples(), 2);
    const bool zero = fit.form.gains() == 2;
    UnitResponse response;
    for (std::size_t k = 0; k < ends.size(); ++k) {
        std::vector<double> slope = ends[k][1];
        for (std::size_t j = 0; j < slope.size(); ++j) slope[j] = (slope[j] - ends[k][0][j]) / spans[k];
        unit_response(record.t, {record.v_time, slope}, fit.shape, zero ? 1 : 0, response);
        auto column = unknowns.slopes.col(static_cast<Eigen::Index>(k));
        column = fit.linear[0] * Eigen::Map<const Eigen::VectorXd>(response.x.data(), record.samples());
        if (zero) column += fit.linear[1] * Eigen::Map<const Eigen::VectorXd>(response.x1.data(), record.samples());
    }
    // The root mean square distance from its end of a value that is equally likely anywhere in the width.
    unknowns.deviation = Eigen::Vector2d(std::numeric_limits<double>::infinity(), at.width / std::sqrt(3.0));
    unknowns.rest = Eigen::Vector2d(0, -ahead);
    return unknowns;
}

}  // namespace tunewright
