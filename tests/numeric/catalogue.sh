#!/bin/sh
# One table of the catalogue of hard cases, and a plot a sweep: catalogue.sh FOLDER-OF-CSV OUTPUT-FOLDER. `make numeric` runs it.
set -e
from=$1 out=$2
mkdir -p "$out"
echo "case,what,bound,worst,bound/worst,unit" > "$out/catalogue.csv"
for f in "$from"/test_*.csv; do
    name=$(basename "$f" .csv)
    case $name in
    *.*) # a sweep: log-log, zeros at the foot
        xlabel=$(head -n 1 "$f" | cut -d, -f1 | sed "s/'/''/g") ylabel=$(head -n 1 "$f" | cut -d, -f2 | sed "s/'/''/g")
        foot=$(awk -F, 'NR > 1 && $2 > 0 && (!m || $2 < m) { m = $2 } END { print m ? m / 10 : 1e-6 }' "$f")
        gnuplot -d <<PLOT
set terminal svg size 640,420 dynamic background '#fcfcfb'
set output '$out/${name#test_}.svg'
set datafile separator ','
set logscale xy
set format '10^{%T}'
set grid lc rgb '#e5e5e2'
set border 3
set tics nomirror
unset key
set xlabel '$xlabel'
set ylabel '$ylabel' noenhanced
plot '$f' every ::1 using 1:(\$2 > 0 ? \$2 : $foot) with linespoints lw 2 pt 7 ps 0.6 lc rgb '#2a78d6', \
     '$f' every ::1 using 1:(\$2 > 0 ? NaN : $foot) with points pt 6 ps 0.9 lc rgb '#2a78d6'
PLOT
        ;;
    *) # ratio: empty where none may be wrong, and none is
        awk -F, -v OFS=, 'NR > 1 { print $1, $2, $3, $4, ($4 > 0 ? $3 / $4 : ""), $5 }' "$f" >> "$out/catalogue.csv" ;;
    esac
done
awk -F, '
    NR == 1 { printf "%-22s %-76s %11s %11s %7s  %s\n", "case", "what", "bound", "worst", "ratio", "unit"; next }
    {
        loose = ($3 > 0 && ($4 == 0 || $3 > 10 * $4)) ? "  << bound over 10 times the worst" : ""
        broken = ($4 > $3 || $4 != $4 + 0) ? "  << BROKEN" : ""
        printf "%-22s %-76s %11.3g %11.3g %7s  %s%s%s\n", $1, $2, $3, $4, ($5 == "" ? "" : sprintf("%.2g", $5)), $6, loose, broken
    }' "$out/catalogue.csv"
echo "table: $out/catalogue.csv   plots: $(ls "$out"/*.svg 2>/dev/null | tr '\n' ' ')"
