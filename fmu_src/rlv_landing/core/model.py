"""The numbers that the kernels need, in SI units, under the paper's symbols."""


class Model:
    """One vehicle on one ground. Attributes are the paper's symbols; `rlv_landing.quantities` says what each means.

    Leg groups: `n_groups` of them; `sin_g`, `cos_g` their azimuth's sine and cosine, `count` the legs in the group
    (mirror images carry the same in-plane quantities), `share_x` the part of the friction at rest along the ground's x.
    """

    def __init__(self, sin_g, cos_g, count, share_x):
        self.n_groups = len(count)
        self.sin_g = sin_g
        self.cos_g = cos_g
        self.count = count
        self.share_x = share_x
