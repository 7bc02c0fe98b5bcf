// The PID law as a regression: moves of u from moves of y and r, their errors a moving average of the first order.
//
// Over samples j with the spacing h, e = r - y_f, D the derivative of y_f through its filter:
//
//   du = Kp' (-dy_f) + b Kp dr + Ki h (r_j - (y_f,j + y_f,j-1)/2) + Kd (-dD_y) + c Kd dD_r + Ki h r0 + w_j - theta
//   w_j-1
//
// linear in Kp', b Kp, Ki, Kd, c Kd and (where r is not recorded) Ki r0, a level of each stretch. theta = 0: the errors
// of u add up (samples between the rows); theta = 1: each u is off for itself (rounding). Kp' is Kp of the trapezoidal
// rule; that of the backward rule is Kp' - Ki Ts/2. Exact for a given theta: w is free at the start of each stretch
// (generalised least squares; Box and Jenkins 1970, section 7.1).
#pragma once

#include <array>
#include <vector>

#include "engine/identification/controller_law/law_samples.h"

namespace tunewright {

/// Columns of the regression; `kLawLevel` is h, the column of Ki r0; `kLawTarget` is du.
enum LawColumn { kLawP, kLawSetPoint, kLawI, kLawD, kLawSetPointD, kLawFilter, kLawLevel, kLawTarget };
inline constexpr int kLawColumns = 8;
using LawColumns = std::array<std::vector<double>, kLawColumns>;

enum class LawFilter { none, derivative, measurement };

/// What makes the regression linear once it is fixed.
struct LawShape {
    double delay_rows = 0;      ///< u answers the y of so many rows before, >= 0; between rows on straight lines
    bool delay_sample = false;  ///< or that of the sample before, where u is a staircase
    LawFilter filter = LawFilter::none;
    double ratio = 0;      ///< Tf over the sample spacing, >= 0; 0: none
    bool between = false;  ///< the controller computes between the rows too: y and r run on straight lines there
};

/// The columns' increments, sample by sample; the first is 0. Not filled: kLawFilter, kLawLevel.
LawColumns law_columns(const LawSamples& samples, const LawShape& shape);

/// Whether the increment that ends at each sample is the law's own.
std::vector<char> law_increments(const LawSamples& samples, bool with_still);

/// True if the set point moves in one of these increments; otherwise its weights have no effect on u.
bool set_point_moves(const LawSamples& samples, const std::vector<char>& used);

/// The columns made white by 1/(1 - theta q^-1), stretch by stretch, rows of other increments left out.
///
/// `drift`: a set point that is not recorded; its integral, a straight line over each stretch of at most
/// kMaxDriftStretch samples, is taken out too.
LawColumns whitened(const LawColumns& columns, const std::vector<char>& used, double theta, bool drift);

/// Of each whitened row the sample at which its increment ends; -1: the free start of a stretch.
std::vector<int> increments_of(const std::vector<char>& used, bool drift);

/// X'X of all columns.
using LawMoments = std::array<std::array<double, kLawColumns>, kLawColumns>;
LawMoments law_moments(const LawColumns& white);

/// Least squares with the columns of `chosen`; the others' coefficients are 0.
struct LawFit {
    std::array<double, kLawColumns> value = {};
    std::array<std::array<double, kLawColumns>, kLawColumns> inverse = {};  ///< of X'X
    double residual = 0;                                                    ///< sum of squares that is left
    bool solved = false;
};
LawFit fit_law(const LawMoments& m, const std::vector<int>& chosen);

}  // namespace tunewright
