/* Ten-point Gauss-Legendre rule on [0, 1]: exact to round-off for what is smooth over the interval. */
#ifndef DEA_SUPPORT_GAUSS_H
#define DEA_SUPPORT_GAUSS_H

enum { DEA_GAUSS_POINTS = 10 };

/* Place of point @p i [1]. */
static inline double dea_gauss_place(int i)
{
    static const double lower[DEA_GAUSS_POINTS / 2] = {0.013046735741414139961, 0.067468316655507744634, 0.160295215850487796883,
                                                       0.283302302935376404600, 0.425562830509184394558};
    return i < DEA_GAUSS_POINTS / 2 ? lower[i] : 1.0 - lower[DEA_GAUSS_POINTS - 1 - i];
}

/* Its weight [1]; they sum to 1. */
static inline double dea_gauss_weight(int i)
{
    static const double lower[DEA_GAUSS_POINTS / 2] = {0.033335672154344068797, 0.074725674575290296573, 0.109543181257991021998,
                                                       0.134633359654998177546, 0.147762112357376435087};
    return lower[i < DEA_GAUSS_POINTS / 2 ? i : DEA_GAUSS_POINTS - 1 - i];
}

#endif
