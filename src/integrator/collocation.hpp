// Collocation methods, rounded from 40 digits.
// Written by tools/make_collocation.py: change that script, not this file.
#pragma once

namespace rolling_ellipse {

// Gauss-Legendre: nodes c, weights b; a_ij = b_j mu_ij with mu_ij + mu_ji = 1 exactly, which keeps
// the rounded method symplectic (Antonana, Makazaga, Murua, Numer. Algorithms 76 (2017) 861).
// nu_ij b_j extrapolates the polynomial of this step to predict the stages of the next one.
template <int Stages>
struct GaussCoefficients;

template <>
struct GaussCoefficients<2> {
    static constexpr double c[2] = {0.2113248654051871, 0.7886751345948129};
    static constexpr double b[2] = {0.5, 0.5};
    static constexpr double mu[2][2] = {
        {0.5, -0.07735026918962573},
        {1.0773502691896257, 0.5},
    };
    static constexpr double nu[2][2] = {
        {-0.2320508075688773, 0.6547005383792516},
        {-1.6547005383792515, 3.232050807568877},
    };
};

template <>
struct GaussCoefficients<3> {
    static constexpr double c[3] = {0.11270166537925831, 0.5, 0.8872983346207417};
    static constexpr double b[3] = {0.2777777777777778, 0.4444444444444444, 0.2777777777777778};
    static constexpr double mu[3][3] = {
        {0.5, -0.08094750193111255, 0.03524199845511},
        {1.0809475019311126, 0.5, -0.08094750193111255},
        {0.96475800154489, 1.0809475019311126, 0.5},
    };
    static constexpr double nu[3][3] = {
        {0.12862997682664962, -0.2714724826199872, 0.7114519907306598},
        {1.7571574942066623, -3.25, 5.242842505793337},
        {6.28854800926934, -10.728527517380012, 14.071370023173351},
    };
};

template <>
struct GaussCoefficients<4> {
    static constexpr double c[4] = {0.06943184420297371, 0.33000947820757187, 0.6699905217924281, 0.9305681557970263};
    static constexpr double b[4] = {0.17392742256872692, 0.32607257743127305, 0.32607257743127305, 0.17392742256872692};
    static constexpr double mu[4][4] = {
        {0.5, -0.08158975003227997, 0.03872592656788576, -0.020440420684040728},
        {1.08158975003228, 0.5, -0.08550375141051925, 0.03872592656788576},
        {0.9612740734321142, 1.0855037514105192, 0.5, -0.08158975003227997},
        {1.0204404206840407, 0.9612740734321142, 1.08158975003228, 0.5},
    };
    static constexpr double nu[4][4] = {
        {-0.08069244221418825, 0.14905251344792275, -0.2863899537704157, 0.7373675982069781},
        {-1.564240823409777, 2.7335856999090917, -4.453342780326907, 6.685774212562962},
        {-9.944249514606016, 16.51811618050403, -23.729528700288643, 27.316060954201383},
        {-26.23071242695553, 42.391553596246375, -57.31898955610101, 59.56643136096108},
    };
};

// Radau IIA with three stages. Its matrix a has inverse(a) = transform . eigenvalues .
// inverse(transform), the eigenvalues being gamma and the pair alpha +- i beta in the real form
// [alpha, -beta; beta, alpha] (Hairer, Wanner, Solving ODEs II, IV.8).
struct RadauCoefficients {
    static constexpr double c[3] = {0.1550510257216822, 0.6449489742783178, 1.0};
    static constexpr double gamma = 3.637834252744496;
    static constexpr double alpha = 2.6810828736277523;
    static constexpr double beta = 3.0504301992474105;
    static constexpr double transform[3][3] = {
        {0.09443876248897524, -0.1412552950209542, -0.030029194105147424},
        {0.2502131229653333, 0.20412935229379994, 0.3829421127572619},
        {1.0, 1.0, 0.0},
    };
    static constexpr double inverse_transform[3][3] = {
        {4.178718591551905, 0.32768282076106237, 0.5233764454994495},
        {-4.178718591551905, -0.32768282076106237, 0.47662355450055044},
        {-0.5028726349457868, 2.571926949855605, -0.5960392048282249},
    };
};

}  // namespace rolling_ellipse
