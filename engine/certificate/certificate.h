// A certified lower bound of the least IAE after a unit load step over all stabilising PI or PID controllers with
// |S| <= Ms and |T| <= Mt, dead time exact: a proof that no controller of a root box is better, as a list of boxes
// that tile it, each with the reason why it holds none (docs/proof.md).
//
//   D(s) = s/P(s) + s C(s),   1/D the Laplace transform of y after a unit load step
//
// Units: the plant's; IAE in y times time.
#pragma once

#include <array>
#include <complex>
#include <optional>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"
#include "engine/progress.h"

namespace tunewright {

/// The controllers that are compared, F(x) = 1/(1 + x + x^2/2).
enum class CertifiedStructure {
    pi,         ///< C = F(s Tf)(k + ki/s)
    pid_fixed,  ///< C = F(s Tf)(k + ki/s + kd s), unknowns (k, ki, kd)
    pid_tied,   ///< C = F(s Td/10)(k (1 + s Td) + ki/s), unknowns (k, ki, Td)
};

/// The plant that the proof is about: num(s)/den(s) e^(-Ls), descending powers of s.
struct CertifiedPlant {
    std::vector<double> num, den;
    double L = 0;
};

struct CertifiedBox {
    std::array<double, 3> low{}, high{};  ///< (k, ki, kd or Td); the third is 0 for a PI
};

enum class LeafReason {
    sensitivity,    ///< |S| > Ms at `omega`
    complementary,  ///< |T| > Mt at `omega`
    error,          ///< |1/D(s)| >= goal at `s`, Re s >= 0
    bound,          ///< the integral of y phi >= goal, within the half-planes of `cuts`
    empty,          ///< the half-planes of `cuts` leave nothing of the box
    unstable,       ///< no pole crosses the axis anywhere in the box, and its centre has one near `s`, Re s > 0
};
const char* to_string(LeafReason reason);

/// The half-plane that a limit at one frequency leaves, with its multiplier >= 0.
struct LimitCut {
    bool complementary = false;  ///< of T; else of S
    double omega = 0, multiplier = 0;
};

struct CertificateLeaf {
    CertifiedBox box;
    LeafReason reason = LeafReason::error;
    double omega = 0;
    std::complex<double> s;
    int phi = 0;
    std::vector<LimitCut> cuts;
};

/// phi(t) = sum a_m cos(m w0 t): the Jackson mean of a sign that is `first` at t = 0 and changes at the angles w0 t,
/// ascending within (0, pi). |phi| <= 1, because Jackson's kernel is positive.
struct SignFunction {
    int first = 1;
    std::vector<double> changes;
};

struct CertificateProblem {
    CertifiedPlant plant;
    CertifiedStructure structure = CertifiedStructure::pi;
    double Tf = 0;                   ///< of pi and pid_fixed, >= 0
    double Ms = 0, Mt = 0;           ///< > 1
    std::array<double, 3> design{};  ///< k, ki and kd or Td of the known design; ki > 0
    double upper = 0;                ///< its IAE
};

struct CertifyOptions {
    double gap = 0.01;            ///< goal = (1 - gap) upper; in (0, 1)
    std::optional<double> reach;  ///< the root box over the design; default kReachOfPi, kReachOfPid
    int max_boxes = 200'000;      ///< ends the search without the whole proof; about 0.3 kB each
    bool keep_leaves = false;     ///< return them
};

inline constexpr double kReachOfPi = 20, kReachOfPid = 4;

struct Certificate {
    CertificateProblem problem;
    double asked_gap = 0;
    double goal = 0;   ///< (1 - asked_gap) upper
    double lower = 0;  ///< the proven bound: `goal` if the search is complete, else the least bound of an open box
    double gap = 0;    ///< (upper - lower)/upper
    bool complete = false;
    CertifiedBox root;
    int boxes = 0;  ///< visited
    std::array<int, 6> leaves_by_reason{};
    double w0 = 0;  ///< of all sign functions
    int harmonics = 0;
    std::vector<SignFunction> phis;
    std::vector<CertificateLeaf> leaves;  ///< tile the root, depth first; empty unless asked for
};

/// The problem of a design whose measurement filter is of second order or absent: PID with Tf = Td/10 is pid_tied.
/// With ki < 0 plant and controller both change their sign, which leaves the loop as it is. `pid`: PIDs are compared,
/// also if the best one has no derivative.
/// Errors: unsupported for another filter, a design without integral action, a plant with a zero at s = 0.
Expected<CertificateProblem> certificate_problem(const LinearPlant& plant, const IdealPid& design, double Ms, double Mt,
                                                 double upper, bool pid);

/// Branch and bound. Stopping early gives the bound proven so far. Errors: invalid_argument for numbers outside their
/// ranges, or a design that is not stable.
Expected<Certificate> certify(const CertificateProblem& problem, const CertifyOptions& options,
                              const RunControl& control);

}  // namespace tunewright
