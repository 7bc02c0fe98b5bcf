// Whether a valve that sticks explains the measurement better than the output itself does: a Hammerstein model against
// a linear one (Karra and Karim 2009, Control Engineering Practice 17, 939; Jelali 2008, Journal of Process Control 18,
// 632).
//
// On block means of about a twelfth of the period, the measurement is regressed on its own past and on the valve's
// position at a delay; the same with the output in its place. Regression A also has the output's own past, as the
// controller's memory, in both; B has not. What the valve explains more counts over tenths of the record, without the
// best two of them: a single event proves nothing.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "engine/check/valve/valve_model.h"

namespace tunewright::check {

/// Measurement and output over the same rows, thinned for a long record and the last ones of a very long one, and the
/// valves' positions over them.
class ValveBank {
public:
    /// `period`: rows of the oscillation that is looked at.
    ValveBank(std::span<const double> output, double period);

    /// The rows of the record from one to the next here.
    std::size_t stride() const { return stride_; }
    /// The last rows of the record that are looked at.
    std::size_t rows() const { return stride_ * output_.size(); }
    const std::vector<double>& output() const { return output_; }
    const std::vector<ValveModel>& valves() const { return valves_; }
    /// The position of valve k, computed when it is first asked for.
    const std::vector<double>& position(std::size_t k) const;
    std::vector<double> thinned(std::span<const double> values) const;

private:
    std::size_t stride_ = 1;
    std::vector<double> output_;
    std::vector<ValveModel> valves_;
    mutable std::vector<std::vector<double>> positions_;
};

/// An oscillation as candidate; rows. `line`: the share of its band's power in a single sine; 0: not one.
struct PeriodCandidate {
    double period = 0, line_period = 0, line = 0;
};

struct ValveFit {
    bool passes = false;
    double gain = 0;      ///< ln of the residual's square, output over valve, without the best two tenths
    double strength = 0;  ///< the gain times the number of blocks: a logarithm of odds
    double band = 0;      ///< u, weighted over the candidates
    double jump = 0;      ///< u
    double period = 0;    ///< rows of the record
};

/// `measurement`: with the sign of the plant's gain as the controller's gain has it. Empty: too few candidates or
/// blocks.
std::optional<ValveFit> fit_valve(std::span<const double> measurement, const ValveBank& bank,
                                  const PeriodCandidate& candidate, double regularity, double sign);

}  // namespace tunewright::check
