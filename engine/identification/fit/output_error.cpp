#include "engine/identification/fit/output_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/numerics/matrix/dense.h"
#include "engine/numerics/matrix/projection.h"
#include "engine/numerics/optimise/levenberg_marquardt.h"

namespace tunewright {
namespace {

/// The square root of 10: a given y0 is assumed to be an average of many readings, and counts as ten samples.
constexpr double kRestWeight = 3.1622776601683795;
/// In a logarithm, for central differences: keeps both truncation (1e-8) and rounding (1e-12) small.
constexpr double kLogDifferenceStep = 1e-4;

int anchor_rows(std::span<const FrequencyConstraint> anchors) {
    int rows = 0;
    for (const FrequencyConstraint& anchor : anchors) rows += anchor.omega > 0 ? 2 : 1;
    return rows;
}

class OutputError {
public:
    OutputError(const FitData& data, const ModelForm& form)
        : record_(*data.record),
          anchors_(data.anchors),
          form_(form),
          n_(record_.samples()),
          first_anchor_(n_ + (record_.y_rest ? 1 : 0)),
          rows_(first_anchor_ + anchor_rows(anchors_)),
          y_(rows_),
          columns_(Eigen::MatrixXd::Zero(rows_, form.linear_size())) {
        for (int i = 0; i < n_; ++i) y_[i] = record_.y[i];
        if (record_.y_rest) y_[n_] = kRestWeight * *record_.y_rest;
        int row = first_anchor_;
        for (const FrequencyConstraint& anchor : anchors_) {
            y_[row++] = anchor.weight * anchor.value.real();
            if (anchor.omega > 0) y_[row++] = anchor.weight * anchor.value.imag();
        }
        y_square_ = square_of(y_);
        // Independent of the shape.
        columns_.col(form_.offset_index()).head(n_).setOnes();
        if (record_.y_rest) columns_(n_, form_.offset_index()) = kRestWeight;
        if (form_.slope) columns_.col(form_.slope_index()).head(n_) = column(record_.t);
    }

    /// n_rows x linear_size, valid until the next call.
    const Eigen::MatrixXd& regressors(const ModelShape& shape) {
        const bool zero = form_.gains() == 2;
        respond(shape, zero ? 1 : 0);
        fill(0, now_, zero);
        if (form_.other_level) fill(form_.level_index(), level_, zero);
        if (form_.load) fill(form_.load_index(), load_, zero);
        for (int k = 0; k < form_.further; ++k) {
            respond_to_further(k, shape, 0);
            columns_.col(form_.further_index() + k).head(n_) = column(further_.x);
        }
        int row = first_anchor_;
        for (const FrequencyConstraint& anchor : anchors_) {
            const std::complex<double> s(0, anchor.omega), g = anchor.weight * unit_transfer(shape, s);
            for (int k = 0; k < form_.gains(); ++k) {
                const std::complex<double> value = k == 0 ? g : s * g;
                columns_(row, k) = value.real();
                if (anchor.omega > 0) columns_(row + 1, k) = value.imag();
            }
            row += anchor.omega > 0 ? 2 : 1;
        }
        return columns_;
    }

    void project(const ModelShape& shape, Projection& result) { project_on(regressors(shape), y_, y_square_, result); }

    /// By normal equations: fast, accurate to the square root of the precision.
    double rough_sum(const ModelShape& shape) {
        const double sum = rough_rest(regressors(shape), y_, y_square_);
        return std::isfinite(sum) ? std::max(sum, 0.0) : std::numeric_limits<double>::max();
    }

    /// d model/d searched, n_rows x searched, valid until the next call.
    Eigen::MatrixXd& sensitivities(const ModelShape& shape, const Eigen::VectorXd& linear) {
        const std::vector<int> places = form_.searched();
        D_.setZero(rows_, static_cast<Eigen::Index>(places.size()));
        const bool zero = form_.gains() == 2;
        respond(shape, zero ? 2 : 1);
        add_slopes(0, 0, now_, -1, linear);
        if (form_.other_level) add_slopes(0, form_.level_index(), level_, -1, linear);
        if (form_.load) add_slopes(shape_size(form_.structure), form_.load_index(), load_, -1, linear);
        add_anchor_slopes(shape, linear);
        const int first_further = static_cast<int>(places.size()) - 2 * form_.further;
        for (int k = 0; k < form_.further; ++k)
            add_further_slopes(first_further + 2 * k, k, shape, linear[form_.further_index() + k]);
        for (int k = 1; k < first_further; ++k) {
            if (places[static_cast<std::size_t>(k)] == kLoadTime) continue;
            for (const double sign : {1.0, -1.0}) {
                ModelShape moved = shape;
                moved.p[places[static_cast<std::size_t>(k)]] += sign * kLogDifferenceStep;
                add_model(k, moved, linear, sign / (2 * kLogDifferenceStep));
            }
        }
        return D_;
    }

    Fit finish(const ModelShape& shape, const Projection& p) const {
        Fit fit;
        fit.form = form_;
        fit.shape = shape;
        fit.linear.assign(p.linear.begin(), p.linear.end());
        fit.residual.assign(p.residual.begin(), p.residual.begin() + n_);
        fit.model.resize(n_);
        for (int i = 0; i < n_; ++i) fit.model[i] = record_.y[i] - fit.residual[i];
        fit.sse = p.sse;
        fit.determined = p.determined;
        return fit;
    }

private:
    static Eigen::Map<const Eigen::VectorXd> column(const std::vector<double>& values) {
        return {values.data(), static_cast<Eigen::Index>(values.size())};
    }

    void respond(const ModelShape& shape, int derivatives) {
        static constexpr double kAtOnce[] = {0}, kUnit[] = {1};
        unit_response(record_.t, {record_.v_time, record_.v_level}, shape, derivatives, now_);
        if (form_.other_level) unit_response(record_.t, {kAtOnce, kUnit}, shape, derivatives, level_);
        if (!form_.load) return;
        ModelShape undelayed = shape;
        undelayed.p[0] = 0;
        const double when[] = {shape.load_time()};
        unit_response(record_.t, {when, kUnit}, undelayed, derivatives, load_);
    }

    void respond_to_further(int k, const ModelShape& shape, int derivatives) {
        const FurtherSteps& input = record_.d[static_cast<std::size_t>(k)];
        unit_response(record_.t, {input.time, input.level}, further_shape(shape, k), derivatives, further_);
    }

    /// d model/d (L, ln T) of further input `k`, into columns `place` and the next.
    void add_further_slopes(int place, int k, const ModelShape& shape, double gain) {
        respond_to_further(k, shape, 1);
        D_.col(place).head(n_) -= gain * column(further_.x1);
        for (const double sign : {1.0, -1.0}) {
            ModelShape moved = shape;
            moved.p[further_lag(k)] += sign * kLogDifferenceStep;
            respond_to_further(k, moved, 0);
            D_.col(place + 1).head(n_) += sign * gain / (2 * kLogDifferenceStep) * column(further_.x);
        }
    }

    void fill(int k, const UnitResponse& response, bool zero) {
        columns_.col(k).head(n_) = column(response.x);
        if (zero) columns_.col(k + 1).head(n_) = column(response.x1);
    }

    /// Adds `sign` times the time derivative of the contribution of the coefficients from `index` on.
    void add_slopes(int place, int index, const UnitResponse& response, double sign, const Eigen::VectorXd& linear) {
        auto target = D_.col(place).head(n_);
        target += sign * linear[index] * column(response.x1);
        if (form_.gains() == 2) target += sign * linear[index + 1] * column(response.x2);
    }

    std::complex<double> anchored(const FrequencyConstraint& anchor, const ModelShape& shape,
                                  const Eigen::VectorXd& linear) const {
        const std::complex<double> s(0, anchor.omega);
        const std::complex<double> gain = form_.gains() == 2 ? linear[0] + linear[1] * s : linear[0];
        return anchor.weight * gain * unit_transfer(shape, s);
    }

    void add_at_anchor(int row, int place, const FrequencyConstraint& anchor, std::complex<double> value) {
        D_(row, place) += value.real();
        if (anchor.omega > 0) D_(row + 1, place) += value.imag();
    }

    void add_anchor_slopes(const ModelShape& shape, const Eigen::VectorXd& linear) {
        int row = first_anchor_;
        for (const FrequencyConstraint& anchor : anchors_) {
            add_at_anchor(row, 0, anchor, -std::complex<double>(0, anchor.omega) * anchored(anchor, shape, linear));
            row += anchor.omega > 0 ? 2 : 1;
        }
    }

    /// Adds `weight` times the model at `shape` to column `place`.
    void add_model(int place, const ModelShape& shape, const Eigen::VectorXd& linear, double weight) {
        const bool zero = form_.gains() == 2;
        respond(shape, zero ? 1 : 0);
        auto add = [&](int index, const UnitResponse& response) {
            auto target = D_.col(place).head(n_);
            target += weight * linear[index] * column(response.x);
            if (zero) target += weight * linear[index + 1] * column(response.x1);
        };
        add(0, now_);
        if (form_.other_level) add(form_.level_index(), level_);
        if (form_.load) add(form_.load_index(), load_);
        int row = first_anchor_;
        for (const FrequencyConstraint& anchor : anchors_) {
            add_at_anchor(row, place, anchor, weight * anchored(anchor, shape, linear));
            row += anchor.omega > 0 ? 2 : 1;
        }
    }

    const CleanRecord& record_;
    std::span<const FrequencyConstraint> anchors_;
    ModelForm form_;
    int n_, first_anchor_, rows_;
    Eigen::VectorXd y_;
    double y_square_ = 0;
    Eigen::MatrixXd columns_, D_;
    UnitResponse now_, level_, load_, further_;
};

ModelShape clamped(ModelShape shape, const ShapeBounds& bounds) {
    for (std::size_t k = 0; k < shape.p.size(); ++k) shape.p[k] = std::clamp(shape.p[k], bounds.low[k], bounds.high[k]);
    return shape;
}

/// Parameters that a step would move beyond their bound are excluded from it.
std::vector<int> free_parameters(const ModelShape& shape, const std::vector<int>& places, const ShapeBounds& bounds,
                                 const Eigen::VectorXd& descent) {
    std::vector<int> free;
    for (int k = 0; k < descent.size(); ++k) {
        const double value = shape.p[places[k]];
        const bool blocked =
            (value <= bounds.low[places[k]] && descent[k] < 0) || (value >= bounds.high[places[k]] && descent[k] > 0);
        if (!blocked) free.push_back(k);
    }
    return free;
}

Eigen::VectorXd damped_step(const Eigen::MatrixXd& normal, const Eigen::VectorXd& descent, const std::vector<int>& free,
                            double damping) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(descent.size());
    const Eigen::MatrixXd A = optimise::damped(normal, damping)(free, free);
    step(free) = solve_symmetric(A, Eigen::VectorXd(descent(free)));
    return step;
}

/// A longer step in a logarithm leaves the region in which the linearisation is valid.
ModelShape moved_by(const ModelShape& shape, const std::vector<int>& places, const Eigen::VectorXd& step,
                    const ShapeBounds& bounds) {
    constexpr double kLongest = 1.5;  // a factor of 4.5
    double longest = 0;
    for (int k = 1; k < step.size(); ++k) longest = std::max(longest, std::abs(step[k]));
    const double shrink = longest > kLongest ? kLongest / longest : 1;
    ModelShape next = shape;
    for (int k = 0; k < step.size(); ++k) next.p[places[k]] += shrink * step[k];
    return clamped(next, bounds);
}

double distance(const ModelShape& a, const ModelShape& b) {
    double largest = 0;
    for (std::size_t k = 0; k < a.p.size(); ++k) largest = std::max(largest, std::abs(a.p[k] - b.p[k]));
    return largest;
}

}  // namespace

std::vector<int> ModelForm::searched() const {
    std::vector<int> places = shape_places(structure);
    if (load) places.push_back(kLoadTime);
    for (int k = 0; k < further; ++k) {
        places.push_back(further_dead_time(k));
        places.push_back(further_lag(k));
    }
    return places;
}

ShapeBounds shape_bounds(const CleanRecord& record, Structure structure) {
    const double spacing = 1.0 / std::max(1, record.samples() - 1);
    ShapeBounds bounds;
    const double shortest = std::log(std::min(0.02 * spacing, 1e-3));
    bounds.low = {0, shortest, std::log(1e-4), 0, shortest};
    bounds.high = {std::max(0.0, record.response_time()), std::log(100.0), std::log(2500.0), 1 - 3 * spacing,
                   std::log(100.0)};
    for (int k = 0; k < kMaxFurtherInputs; ++k) {
        bounds.low[further_lag(k)] = shortest, bounds.high[further_lag(k)] = std::log(10.0);
        bounds.high[further_dead_time(k)] = 0.5;
    }
    if (structure == Structure::ipdt_second) bounds.high[1] = std::log(10.0);
    if (structure == Structure::ipdt_lag) bounds.high[1] = std::log(10.0);
    if (structure == Structure::unstable) bounds.low[1] = kMinUnstable, bounds.high[1] = std::log(10.0);
    return bounds;
}

Fit project(const FitData& data, const ModelForm& form, const ModelShape& shape) {
    OutputError problem(data, form);
    Projection here;
    problem.project(shape, here);
    return problem.finish(shape, here);
}

std::vector<double> sums_of_squares(const FitData& data, const ModelForm& form, const std::vector<ModelShape>& shapes,
                                    const std::stop_token& stop) {
    OutputError problem(data, form);
    std::vector<double> sums(shapes.size(), std::numeric_limits<double>::max());
    for (std::size_t i = 0; i < shapes.size() && !stop.stop_requested(); ++i) sums[i] = problem.rough_sum(shapes[i]);
    return sums;
}

namespace {

constexpr double kMinStep = 1e-9;  // a smaller step changes only digits below the noise

/// The search over the shape, as a problem of `levenberg_marquardt`.
class ShapeFit {
public:
    ShapeFit(const FitData& data, const ModelForm& form, const ModelShape& start, const Effort& effort,
             const std::stop_token& stop)
        : problem_(data, form),
          places_(form.searched()),
          bounds_(shape_bounds(*data.record, form.structure)),
          effort_(effort),
          stop_(stop),
          shape_(clamped(start, bounds_)) {
        problem_.project(shape_, here_);
    }

    Fit run() {
        const int iterations = optimise::levenberg_marquardt(*this, effort_.max_iterations);
        Fit fit = problem_.finish(shape_, here_);
        fit.iterations = iterations;
        return fit;
    }

    bool linearise() {
        if (!here_.determined || stop_.stop_requested()) return false;
        Eigen::MatrixXd& D = problem_.sensitivities(shape_, here_.linear);
        take_out(here_.basis, D);
        equations_ = normal_equations(D, here_.residual);
        free_ = free_parameters(shape_, places_, bounds_, equations_.right);
        return !free_.empty() && equations_.matrix.diagonal().maxCoeff() > 0;
    }

    optimise::Trial try_step(double damping) {
        using optimise::Trial;
        const Eigen::VectorXd step = damped_step(equations_.matrix, equations_.right, free_, damping);
        const ModelShape next = moved_by(shape_, places_, step, bounds_);
        const double moved = distance(next, shape_);
        problem_.project(next, there_);
        bool converged = !(moved > kMinStep);
        const bool better = there_.sse < here_.sse;
        if (better) {
            converged |= here_.sse - there_.sse < effort_.tolerance * here_.sse;
            shape_ = next;
            std::swap(here_, there_);
        }
        return converged ? Trial::end : better ? Trial::better : Trial::worse;
    }

private:
    OutputError problem_;
    const std::vector<int> places_;
    const ShapeBounds bounds_;
    const Effort& effort_;
    const std::stop_token& stop_;
    ModelShape shape_;
    Projection here_, there_;
    NormalEquations equations_;
    std::vector<int> free_;
};

}  // namespace

Fit fit_shape(const FitData& data, const ModelForm& form, const ModelShape& start, const Effort& effort,
              const std::stop_token& stop) {
    return ShapeFit(data, form, start, effort, stop).run();
}

void jacobian(const FitData& data, Fit& fit) {
    OutputError problem(data, fit.form);
    const Eigen::MatrixXd columns = problem.regressors(fit.shape);
    const Eigen::VectorXd linear =
        Eigen::Map<const Eigen::VectorXd>(fit.linear.data(), static_cast<Eigen::Index>(fit.linear.size()));
    const Eigen::MatrixXd& D = problem.sensitivities(fit.shape, linear);
    fit.J.clear();
    for (const Eigen::MatrixXd* part : {&D, &columns}) {
        for (int k = 0; k < part->cols(); ++k) fit.J.emplace_back(part->col(k).begin(), part->col(k).end());
    }
    fit.held_errors.assign(data.record->y_rest ? 1 : 0, 0.0);
    for (const FrequencyConstraint& anchor : data.anchors)
        fit.held_errors.insert(fit.held_errors.end(), anchor.omega > 0 ? 2 : 1, anchor.weight * anchor.std);
}

}  // namespace tunewright
