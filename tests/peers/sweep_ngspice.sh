#!/bin/sh
# The lumped sweep of Figure 10 by the program ngspice, one process a point: displacement as voltage, compliance as resistance.
# Prints model,microseconds_per_point,coverage,strain for each point. Usage: sweep_ngspice.sh [POINTS]
points=${1:-20}
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
cd "$folder" || exit 1
: >.spiceinit
export LC_ALL=C
i=0
while [ "$i" -le "$points" ]; do
    awk -v i="$i" -v n="$points" 'BEGIN {
        r = 0.03; h = 100e-6; pre = 1.2; u = 4500; b = 0.1 + 0.8*i/n
        j = 2*pre^2 + pre^-4 - 3; w = 178426 - 2*6023*j + 3*4234*j^2; g = pre^2 - pre^-4
        y = 2*(2*pre + 4*pre^-5)*w + 2*g*(6*4234*j - 2*6023)*4*(pre - pre^-5)
        a = 2*3.14159265358979323846*b*r*h/pre^2
        printf "* dot actuator, coverage %.17g\nra edge 0 %.17g\nrp edge 0 %.17g\n", b, b*r/(y*a), (1 - b)*r/(y*a)
        printf "if 0 edge %.17g\n.control\nset numdgt=16\nop\nprint v(edge)/%.17g\nquit 0\n.endc\n.end\n", 8.8541878128e-12*2.8*pre^4*(u/h)^2*a, b*r
    }' >"$i.cir"
    i=$((i + 1))
done
start=$(date +%s%N)
i=0
while [ "$i" -le "$points" ]; do
    ngspice -b "$i.cir" >"$i.out" 2>&1 || { cat "$i.out" >&2; exit 1; }
    i=$((i + 1))
done
end=$(date +%s%N)
i=0
while [ "$i" -le "$points" ]; do
    awk -v i="$i" -v n="$points" -v t="$(((end - start) / 1000))" '/^v\(edge\)/ {printf "lumped,%.6g,%.17g,%s\n", t/(n + 1), 0.1 + 0.8*i/n, $NF}' "$i.out"
    i=$((i + 1))
done
