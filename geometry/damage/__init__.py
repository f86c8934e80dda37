"""What is wrong with a tooth: root cracks (straight, turning, in parts of the width) and pits (circular, elliptic).

Where the damage lies on the tooth, and the cracks' seams in a mesh; what it does to stiffness is computed in `gearfe`.
"""
