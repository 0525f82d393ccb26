"""The colours of all pictures.

They differ in lightness as well as in hue: they read in grey and for colour-blind eyes.
"""

from matplotlib.colors import LinearSegmentedColormap, to_rgb

INK, BLUE, ORANGE, GREY, EARTH = "#14213d", "#2a6f97", "#e07a00", "#7d8996", "#e9e4da"
SKY, PLUM = "#8fc3e0", "#7a2e4d"
FILL = to_rgb(BLUE)
TIMES = LinearSegmentedColormap.from_list("times", ["#bcd9ea", BLUE, INK])  # early to late
