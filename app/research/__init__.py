"""What the five papers print and what comes out when it is computed: their figures, errata and gaps."""
