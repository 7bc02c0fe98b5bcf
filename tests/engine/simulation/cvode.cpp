#include "tests/engine/simulation/cvode.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <stdexcept>

namespace tunewright {
namespace {

int call(realtype t, N_Vector x, N_Vector dx, void* rates) {
    (*static_cast<const CvodeRates*>(rates))(t, N_VGetArrayPointer(x), N_VGetArrayPointer(dx));
    return 0;
}

void check(int flag) {
    if (flag < 0) throw std::runtime_error("CVODE failed with " + std::to_string(flag));
}

}  // namespace

std::vector<std::vector<double>> cvode_states(const CvodeRates& rates, std::vector<double> x, double t_end, int samples,
                                              double relative_tolerance, const std::vector<double>& sizes) {
    const auto n = static_cast<sunindextype>(x.size());
    std::vector<double> absolute;
    for (const double size : sizes) absolute.push_back(relative_tolerance * size);
    SUNContext context = nullptr;
    check(SUNContext_Create(nullptr, &context));
    N_Vector state = N_VMake_Serial(n, x.data(), context), tolerances = N_VMake_Serial(n, absolute.data(), context);
    SUNMatrix matrix = SUNDenseMatrix(n, n, context);
    SUNLinearSolver solver = SUNLinSol_Dense(state, matrix, context);
    void* memory = CVodeCreate(CV_BDF, context);
    CvodeRates own = rates;
    check(CVodeInit(memory, call, 0, state));
    check(CVodeSVtolerances(memory, relative_tolerance, tolerances));
    check(CVodeSetUserData(memory, &own));
    check(CVodeSetLinearSolver(memory, solver, matrix));
    check(CVodeSetMaxNumSteps(memory, 10'000'000));
    std::vector<std::vector<double>> states = {x};
    for (int i = 1; i < samples; ++i) {
        double reached = 0;
        check(CVode(memory, t_end * i / (samples - 1), state, &reached, CV_NORMAL));
        states.push_back(x);
    }
    CVodeFree(&memory);
    SUNLinSolFree(solver);
    SUNMatDestroy(matrix);
    N_VDestroy(state);
    N_VDestroy(tolerances);
    SUNContext_Free(&context);
    return states;
}

}  // namespace tunewright
