// Numerical integration of one smooth function, for the closed forms that end in an integral.
#pragma once

namespace penumbra::analytic {

/// Composite Simpson rule on [a, b]. Error O(h^4) where the function is smooth: put the ends at its kinks.
template <class Function>
double integrate(double a, double b, Function f, int panels = 4096) {
    const double h = (b - a) / panels;
    double sum = 0;
    for (int i = 0; i < panels; ++i) {
        const double x = a + h * i;
        sum += f(x) + 4 * f(x + .5 * h) + f(x + h);
    }
    return sum * h / 6;
}

}  // namespace penumbra::analytic
