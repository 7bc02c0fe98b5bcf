// Truncated Taylor series through a program: each register holds the coefficients of a function of time, and one sweep
// over the instructions adds the next coefficient of all of them (recurrences of automatic differentiation). The
// coefficients are doubles or dual numbers.
//
// Source: Griewank & Walther, Evaluating Derivatives, 2nd ed. 2008, chapter 13 (Table 13.1 and 13.2).
#pragma once

#include <cmath>
#include <vector>

#include "engine/plant/expression/program.h"
#include "engine/plant/expression/scalar.h"

namespace tunewright {

template <class T>
class TaylorTable {
public:
    /// Coefficients 0 to `order`. The program must outlive the table.
    TaylorTable(const Program& program, int order) : program_(program), stride_(static_cast<std::size_t>(order) + 1) {
        const auto registers = static_cast<std::size_t>(program.registers());
        const std::size_t wanted = 2 * registers * stride_;
        if (wanted > kOnStack) heap_.resize(wanted);
        coefficients_ = wanted > kOnStack ? heap_.data() : stack_;
        helpers_ = coefficients_ + registers * stride_;
        T* constant = series(program.variables());
        for (const double value : program.constants()) {
            set_constant(constant[0], value);
            for (std::size_t k = 1; k < stride_; ++k) set_constant(constant[k], 0);
            constant += stride_;
        }
    }
    TaylorTable(const TaylorTable&) = delete;
    TaylorTable& operator=(const TaylorTable&) = delete;

    /// The coefficients of one register; for a variable, to be filled in up to the required order.
    T* series(int at) { return coefficients_ + static_cast<std::size_t>(at) * stride_; }

    /// Computes coefficient k of the first `length` instructions; all lower ones must have been computed.
    void sweep(int k, int length) {
        const int first = program_.registers() - static_cast<int>(program_.instructions().size());
        const Instruction* instruction = program_.instructions().data();
        for (int i = 0; i < length; ++i, ++instruction)
            coefficient(*instruction, k, series(first + i), helpers_ + static_cast<std::size_t>(i) * stride_);
    }

private:
    static constexpr std::size_t kOnStack = 512;

    static T zero() {
        T result;
        set_constant(result, 0);
        return result;
    }

    // sum over j = 1 to k of j a_j w_(k-j), over k: the coefficient of the integral of a' w.
    static T integral(const T* a, const T* w, int k) {
        T sum = zero();
        for (int j = 1; j <= k; ++j) sum = sum + (a[j] * w[k - j]) * (static_cast<double>(j) / k);
        return sum;
    }

    // sum over j = from to to of a_j b_(k-j).
    static T convolution(const T* a, const T* b, int k, int from, int to) {
        T sum = zero();
        for (int j = from; j <= to; ++j) sum = sum + a[j] * b[k - j];
        return sum;
    }

    // `w` holds a second series that the recurrence needs: cos for sin, 1 + tan^2 for tan, ...
    void coefficient(const Instruction& i, int k, T* r, T* w) {
        const T* a = series(i.a);
        const T* b = series(i.b);
        const T* c = series(i.c);
        if (k == 0) {
            r[0] = apply(i.operation, a[0], b[0], c[0]);
            start_helper(i.operation, a[0], r[0], w);
            return;
        }
        const double x = value_part(a[0]), y = value_part(b[0]);
        switch (i.operation) {
            case Operation::add: r[k] = a[k] + b[k]; break;
            case Operation::subtract: r[k] = a[k] - b[k]; break;
            case Operation::negate: r[k] = -a[k]; break;
            case Operation::multiply: r[k] = convolution(a, b, k, 0, k); break;
            case Operation::divide: r[k] = (a[k] - convolution(b, r, k, 1, k)) / b[0]; break;
            case Operation::exp: r[k] = integral(a, r, k); break;
            case Operation::log: r[k] = (a[k] - integral_of_lower(r, a, k)) / a[0]; break;
            case Operation::sqrt: r[k] = (a[k] - convolution(r, r, k, 1, k - 1)) / (r[0] * 2.0); break;
            case Operation::power: r[k] = power(a, r, y, k); break;
            case Operation::sin:
            case Operation::cos: {
                const bool is_sin = i.operation == Operation::sin;
                const T by_helper = integral(a, w, k), by_result = integral(a, r, k);
                r[k] = is_sin ? by_helper : -by_helper;
                w[k] = is_sin ? -by_result : by_result;
                break;
            }
            case Operation::tan:
            case Operation::tanh: {
                r[k] = integral(a, w, k);
                const T square = convolution(r, r, k, 0, k);
                w[k] = i.operation == Operation::tan ? square : -square;
                break;
            }
            case Operation::select: r[k] = x != 0 ? b[k] : c[k]; break;
            case Operation::abs: r[k] = x < 0 ? -a[k] : a[k]; break;
            case Operation::min: r[k] = x <= y ? a[k] : b[k]; break;
            case Operation::max: r[k] = x >= y ? a[k] : b[k]; break;
            default: r[k] = zero(); break;  // comparisons are piecewise constant
        }
    }

    static void start_helper(Operation operation, const T& a, const T& r, T* w) {
        using std::cos, std::sin;
        T one;
        set_constant(one, 1);
        if (operation == Operation::sin) w[0] = cos(a);
        if (operation == Operation::cos) w[0] = sin(a);
        if (operation == Operation::tan) w[0] = one + r * r;
        if (operation == Operation::tanh) w[0] = one - r * r;
    }

    static T integral_of_lower(const T* r, const T* a, int k) {
        T sum = zero();
        for (int j = 1; j < k; ++j) sum = sum + (r[j] * a[k - j]) * (static_cast<double>(j) / k);
        return sum;
    }

    static T power(const T* a, const T* r, double exponent, int k) {
        T sum = zero();
        for (int j = 1; j <= k; ++j) sum = sum + (a[j] * r[k - j]) * (exponent * j - (k - j));
        return sum / (a[0] * static_cast<double>(k));
    }

    const Program& program_;
    std::size_t stride_;
    T* coefficients_;
    T* helpers_;
    T stack_[kOnStack];
    std::vector<T> heap_;
};

}  // namespace tunewright
