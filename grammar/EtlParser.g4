// The grammar of Embedding Temporal Logic. docs/language.md explains it.
//
// Formulas and expressions share one ladder of rules, from the loosest operator to the tightest:
// `(x + y) * 2 > 1` and `(a && b)` begin alike, and a parser that had to tell them apart at the
// bracket would read ahead without bound. compiler/parse tells them apart as it builds the tree,
// where it knows which of the two may stand. Every decision but those on contextual words takes one
// token of lookahead. Chains are loops, not recursion.
parser grammar EtlParser;

options { tokenVocab = EtlLexer; }

spec
    : declaration* EOF
    ;

declaration
    : SPEC name SEMICOLON                                                 # SpecDeclaration
    | RATE amount HERTZ rounding? SEMICOLON                               # RateDeclaration
    | PERIOD (NUMBER timeUnit | name timeUnit?) rounding? SEMICOLON       # PeriodDeclaration
    | CONST name ASSIGN MINUS? NUMBER unit? SEMICOLON                     # ConstDeclaration
    | ENCODER name ASSIGN load (COMMA setting)* SEMICOLON                  # EncoderDeclaration
    | INPUT name (COMMA name)* COLON type encodedBy? range? hold? missing? stale? SEMICOLON
                                                                          # InputDeclaration
    | PROJECTION name ASSIGN (fitted | numbers (OFFSET numbers)?) (IN name)? SEMICOLON
                                                                          # ProjectionDeclaration
    | TARGET name ASSIGN (fitted | source (COMMA source)* (encodedBy | OF point)?) SEMICOLON
                                                                          # TargetDeclaration
    | PREDICATE name ASSIGN sum comparisonOperator threshold missing? SEMICOLON
                                                                          # PredicateDeclaration
    | TRUTH name ASSIGN formula SEMICOLON                                 # TruthDeclaration
    | LET name ASSIGN formula SEMICOLON                                   # LetDeclaration
    | kind=(SLIDING | RESTARTABLE | REPEATING)? MONITOR name ASSIGN formula calibrated? SEMICOLON
                                                                          # MonitorDeclaration
    | DRIFT name ASSIGN OF name (COMMA argument)* SEMICOLON               # DriftDeclaration
    ;

rounding
    : COMMA DURATIONS op=(UP | DOWN | NEAREST)
    ;

// ---- formulas and expressions, from the loosest operator to the tightest

formula
    : implication (IFF implication)*
    ;

implication
    : disjunction (IMPLIES implication)?
    ;

disjunction
    : conjunction (OR conjunction)*
    ;

conjunction
    : binaryTemporal (AND binaryTemporal)*
    ;

binaryTemporal
    : prefixed ( op=(UNTIL | RELEASE | SINCE) interval? binaryTemporal
               | op=WEAK_UNTIL binaryTemporal
               )?
    ;

prefixed
    : comparison                                                                 # Atom
    | op=(NOT | NEXT | PREVIOUS | RISE | FALL) prefixed                          # PlainPrefix
    | op=(EVENTUALLY | ALWAYS | ONCE | HISTORICALLY) interval? prefixed          # IntervalPrefix
    | op=HELD duration prefixed                                                  # HeldPrefix
    ;

// One comparison is right; more, and thresholds, are accepted here only to be explained. A text is
// the name of a subtask.
comparison
    : sum (comparisonOperator (sum | calibrated | STRING))*
    ;

sum
    : product ((PLUS | MINUS) product)*
    ;

product
    : factor ((TIMES | DIVIDE) factor)*
    ;

factor
    : MINUS factor              # Negation
    | primary (AT delay)*       # Unsigned
    ;

primary
    : NUMBER                                                    # NumberPrimary
    | op=(TRUE | FALSE)                                         # ConstantPrimary
    | distance                                                  # DistancePrimary
    | op=(ABS | SQRT) LPAREN formula RPAREN                     # UnaryFunctionPrimary
    | op=(MIN | MAX | MEAN) LPAREN formula (COMMA formula unit?)+ RPAREN
                                                                # VariadicFunctionPrimary
    | op=(COUNT | FRACTION) LPAREN formula COMMA bound RPAREN   # CountPrimary
    | name                                                      # NamePrimary
    | LPAREN formula RPAREN                                     # BracketPrimary
    ;

comparisonOperator
    : LESS_EQUAL | LESS | GREATER_EQUAL | GREATER | EQUAL | NOT_EQUAL
    ;

interval
    : LBRACKET bound COMMA bound RBRACKET
    ;

duration
    : LBRACKET bound RBRACKET
    ;

bound
    : amount unit?      # FiniteBound
    | INF               # InfiniteBound
    | calibrated        # CalibratedBound
    ;

// ---- distances

distance
    : aggregation? metric LPAREN point COMMA point RPAREN
    ;

aggregation
    : op=(MIN | MAX | MEAN)         # PlainAggregation
    | KTH LPAREN amount RPAREN      # KthAggregation
    ;

metric
    : DISTANCE                              # PlainMetric
    | MAHALANOBIS LPAREN weights RPAREN     # WeightedMetric
    ;

weights
    : load      # LoadedWeights
    | literal   # LiteralWeights
    | fitted    # FittedWeights
    | name      # NamedWeights
    ;

// As the second point of a distance, a name may be that of a target.
point
    : MINUS? (NUMBER TIMES)? located (TIMES located)?
      ((PLUS | MINUS) (NUMBER TIMES)? located (TIMES located)?)*
    ;

// Before TIMES, the name of a constant.
located
    : ( name (LPAREN point RPAREN)?
      | LBRACKET point (COMMA point)* RBRACKET
      | LPAREN point RPAREN
      ) (AT delay)*
    ;

// How long ago: steps or a duration.
delay
    : amount unit?
    ;

// ---- thresholds

threshold
    : sum           # GivenThreshold
    | calibrated    # CalibratedThreshold
    ;

calibrated
    : CALIBRATED LPAREN name (COMMA argument)* RPAREN
    ;

// A unit is for times.
argument
    : name ASSIGN number unit?
    ;

// ---- encoders

setting
    : op=(IMAGE | MEAN | DEVIATION) row
    | op=RESIZE name row?
    | op=(FLIP | CHANNELS | MARGINS | POOL) name
    | op=OUTPUT STRING
    | op=PREPROCESSOR load
    ;

encodedBy
    : BY name
    ;

// ---- inputs

type
    : F32 dimension?                        # Float32Type
    | F16 dimension                         # Float16Type
    | I8 dimension (SCALE number)?          # Int8Type
    | BOOL                                  # BoolType
    ;

dimension
    : LBRACKET amount RBRACKET
    ;

range
    : IN LBRACKET limit COMMA limit RBRACKET
    ;

limit
    : MINUS? (amount | INF)
    ;

hold
    : HOLD amount unit?
    ;

missing
    : MISSING op=(TRUE | FALSE)
    ;

stale
    : COMMA STALE AFTER amount unit?
    ;

// ---- data

numbers
    : load | literal
    ;

source
    : load | literal | frames | images
    ;

// Without a key, of a video.
frames
    : FRAMES LPAREN path=STRING COMMA (key=STRING COMMA)? LBRACKET amount (COMMA amount)* RBRACKET
      stride? RPAREN
    ;

images
    : IMAGES LPAREN path=STRING RPAREN
    ;

stride
    : COMMA STRIDE ASSIGN amount
    ;

fitted
    : FITTED LPAREN name (COMMA fittedArgument)* RPAREN
    ;

fittedArgument
    : OF ASSIGN point               # PointArgument
    | WHERE ASSIGN formula          # FormulaArgument
    | IDENTIFIER ASSIGN amount      # NumberArgument
    ;

load
    : LOAD LPAREN path=STRING (COMMA key=STRING)? RPAREN
    ;

literal
    : LBRACKET row (COMMA row)* RBRACKET            # MatrixLiteral
    | LBRACKET number (COMMA number)* RBRACKET      # VectorLiteral
    ;

row
    : LBRACKET number (COMMA number)* RBRACKET
    ;

number
    : MINUS? amount
    ;

// A name is that of a constant.
amount
    : NUMBER | name
    ;

timeUnit
    : MICROSECONDS | MILLISECONDS | SECONDS | MIN
    ;

unit
    : timeUnit | STEPS
    ;

// ---- names: contextual words are names wherever they cannot be keywords

name
    : IDENTIFIER
    | IN | HOLD | MISSING | SCALE | STALE | AFTER
    | F32 | F16 | I8 | BOOL
    | RESTARTABLE | REPEATING | DRIFT
    | RISE | FALL | HELD
    | PROJECTION | OFFSET | FITTED | FRAMES | STRIDE | OF | WHERE
    | ENCODER | BY | IMAGES | IMAGE | DEVIATION | RESIZE | FLIP | CHANNELS
    | MARGINS | OUTPUT | POOL | PREPROCESSOR
    | DURATIONS | UP | DOWN | NEAREST
    | HERTZ | MICROSECONDS | MILLISECONDS | SECONDS | STEPS
    | DISTANCE | MAHALANOBIS
    | MIN | MAX | MEAN | KTH | COUNT | FRACTION | ABS | SQRT
    ;
