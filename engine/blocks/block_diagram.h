// Linear blocks with dead times, joined at signals: the loops of a cascade, of interacting outputs, of a predictor.
//
//   x(s) = M(s) x(s) + w(s),   M_ij = sum of the blocks from j to i,   H = (I - M)^-1
//
// w is what enters at the signals from outside: a set point, a load. In the loop broken at signal k the sensitivity is
// S = H_kk, so T = 1 - H_kk, and the open loop is L = 1/H_kk - 1, whatever other loops are closed.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "engine/controller/pid.h"
#include "engine/expected.h"
#include "engine/plant/linear/linear_plant.h"

namespace tunewright {

/// P(s) from one signal to another, dead time included.
struct Block {
    int from = 0, to = 0;
    LinearPlant plant;
    /// True: the block's input has zeros at its poles, so these are no poles of the loops. Example: the model of an
    /// integrator in a predictor, whose input is u minus the filtered past of u.
    bool cancelled = false;
};

constexpr int kMaxSignals = 20;  ///< of a diagram, so that its matrices need no memory from the heap
using SignalMatrix =
    Eigen::Matrix<std::complex<double>, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, kMaxSignals, kMaxSignals>;
using SignalVector = Eigen::Matrix<std::complex<double>, Eigen::Dynamic, 1, 0, kMaxSignals, 1>;

class BlockDiagram {
public:
    /// A new signal's number, from 0; at most kMaxSignals.
    int add_signal();

    void add(int from, int to, LinearPlant plant, bool cancelled = false) {
        blocks_.push_back({from, to, std::move(plant), cancelled});
    }
    /// gain e^(-Ls); none for a gain of 0.
    void add(int from, int to, double gain, double L = 0);

    int signals() const { return signals_; }
    const std::vector<Block>& blocks() const { return blocks_; }
    /// Poles of all blocks together, without those that are cancelled.
    int order() const;
    /// Of all blocks.
    double total_dead_time() const;
    /// Dead times and lags of all blocks together; of integrators and gains alone their common time; 0: only gains.
    double time_scale() const;

    SignalMatrix connections(std::complex<double> s) const;  ///< M(s)
    /// H(s) w for one signal's w = 1: all signals.
    SignalVector response(std::complex<double> s, int input) const;
    /// The characteristic function det(I - M) times the denominators of all blocks: finite everywhere, and its zeros
    /// are the poles of H, those that cancel in H included.
    std::complex<double> characteristic(std::complex<double> s) const;

private:
    int signals_ = 0;
    std::vector<Block> blocks_;
};

/// The signals of a PID controller in a diagram. `output` is what the blocks of the controller add up to, and what
/// enters there from outside: a load at the plant's input.
struct PidSignals {
    int error = 0;   ///< set point minus filtered measurement; the set point enters here from outside
    int output = 0;  ///< u
};

/// Adds a controller of the measurement `y`. Set-point weights are those of the error: b = 1 and c = 0. The error names
/// the derivative without a filter, which no proper block has.
Expected<PidSignals> add_pid(BlockDiagram& diagram, const ParallelPid& pid, int y);

}  // namespace tunewright
